import re

import pytest

from stairwright.errors import InputError
from stairwright.terrain.tables import parse_table

EXPECTED = [(0.0, 0.0), (1.0, 0.0), (1.0, 0.25), (2.0, 0.25)]


@pytest.mark.parametrize(
    "text",
    [
        "0,0\n1,0\n1,0.25\n2,0.25\n",
        "x,z\n0,0\n1,0\n1,0.25\n2,0.25",
        "\ufeffx;z\r\n0;0\r\n1;0\r\n1;0,25\r\n2;0,25\r\n",
        "# drawn by hand\n\n0\t0\n1\t0\n1\t.25\n2\t2.5e-1\n",
        "0 0\n1 0\n1   0.25\n2 0.25",
    ],
)
def test_separators_headers_comments(text):
    assert parse_table(text).points == EXPECTED


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "two rows"),
        ("x,z\n1,2\n", "two rows"),
        ("0,0\n1,zero\n", "line 2"),
        ("0,0\n1,2,3\n", "line 2"),
        ("x,z\ny,w\n0,0\n1,1\n", "line 2"),
        ("0,0\n1,nan\n", "line 2"),
        ("# kerb\n0,0\n\n-1,0\n", "^line 4: .* in line 2"),
        ("0,0\n101,0\n", "^line 2: "),
    ],
)
def test_bad_tables_say_where(text, message):
    with pytest.raises(InputError) as caught:
        parse_table(text)
    assert re.search(message, caught.value.message)
    assert caught.value.field == ("file",)
    assert "point" not in caught.value.message  # lines are numbered from 1, points from 0
