"""Setting up, shipping: container files, the wheel, `./dev` and CI's script."""

from __future__ import annotations

import os
import re
import shutil
import socket
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest
import yaml

from tools import packages, running, steps

ROOT = Path(__file__).resolve().parents[1]


def run(*command: str | Path, **options: object) -> subprocess.CompletedProcess[str]:
    return subprocess.run(command, capture_output=True, text=True, check=False, **options)


# ---------------------------------------------------------------- containers


def test_compose_file_meets_its_schema() -> None:
    check = run(
        sys.executable, "-m", "check_jsonschema", "--builtin-schema", "vendor.compose-spec",
        ROOT / "docker-compose.yml",
    )  # fmt: skip
    assert check.returncode == 0, check.stdout + check.stderr


def test_container_has_as_many_workers_as_processors() -> None:
    """Docker refuses more processors than the machine has: hence a variable, a small default."""
    compose = yaml.safe_load((ROOT / "docker-compose.yml").read_text(encoding="utf-8"))
    service = compose["services"]["stairwright"]
    share = service["deploy"]["resources"]["limits"]["cpus"]
    assert share == "${STAIRWRIGHT_CPUS:-2}"
    assert service["environment"]["STAIRWRIGHT_PLAN_WORKERS"] == share
    assert service["environment"]["STAIRWRIGHT_ROLLOUT_WORKERS"] == share


def test_dockerfile_passes_hadolint() -> None:
    check = run(Path(sys.executable).with_name("hadolint"), ROOT / "Dockerfile")
    assert check.returncode == 0, check.stdout + check.stderr


def test_docker_context_holds_what_the_dockerfile_copies() -> None:
    copied = re.findall(
        r"^COPY (?!--from)(?:--\S+ )*(.+) \S+$", (ROOT / "Dockerfile").read_text(), re.M
    )
    allowed = set(re.findall(r"^!(\S+)$", (ROOT / ".dockerignore").read_text(), re.M))
    sources = {source.split("/")[0] for line in copied for source in line.split()}
    assert sources == allowed
    assert all((ROOT / source).exists() for source in sources)


# ---------------------------------------------------------------- the wheel


@pytest.mark.slow
def test_wheel_brings_its_terrains_robots_and_page(tmp_path: Path) -> None:
    """Built from the tracked files plus page and native core; used without the checkout."""
    source = tmp_path / "source"
    files = run("git", "ls-files", "-z", "--cached", "--others", "--exclude-standard", cwd=ROOT)
    for name in filter(None, files.stdout.split("\0")):
        if (ROOT / name).is_file():
            (source / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(ROOT / name, source / name)
    build = (sys.executable, "-m", "hatchling", "build", "--target", "wheel")
    unbuilt = run(*build, cwd=source)
    assert unbuilt.returncode != 0
    (sentence,) = unbuilt.stderr.strip().splitlines()
    assert sentence.endswith(
        "must be built first; one command builds them and the wheel: ./dev wheel"
    )
    pip = (sys.executable, "-m", "pip", "wheel", "--no-deps", "--no-build-isolation", ".")
    refused = run(*pip, cwd=source)
    assert refused.returncode != 0
    assert sentence in refused.stdout + refused.stderr
    assert "Traceback" not in refused.stdout + refused.stderr

    assert (ROOT / "frontend" / "dist" / "index.html").is_file(), (
        "build the page first: ./dev build"
    )
    shutil.copytree(ROOT / "frontend" / "dist", source / "frontend" / "dist")
    package = Path("backend", "stairwright")
    for core in (ROOT / package).glob("_core.*"):
        shutil.copy(core, source / package / core.name)
    built = run(*pip, "--wheel-dir", "dist", cwd=source)
    assert built.returncode == 0, built.stderr
    (wheel,) = (source / "dist").glob("*.whl")
    unpacked = tmp_path / "unpacked"
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(unpacked)
    assert (unpacked / "stairwright" / "page" / "index.html").is_file()
    assert (unpacked / "stairwright" / "py.typed").is_file()
    program = "import stairwright as sw; from stairwright import _core; "
    program += "print(_core.__file__, *sw.robots(), *sw.terrains())"
    env = os.environ | {"PYTHONPATH": str(unpacked)}
    used = run(sys.executable, "-c", program, cwd=tmp_path, env=env)
    assert used.returncode == 0, used.stderr
    place, *names = used.stdout.split()
    assert place.startswith(str(unpacked))
    assert {"a1_wheeled", "a1_wheeled_x", "single-stair-036", "three-stairs-up-down"} <= {*names}


# ---------------------------------------------------------------- ./dev and .ci/run


def test_a_step_runs_again_only_when_what_it_read_has_changed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(steps, "ROOT", tmp_path)
    source, stamp = tmp_path / "source", tmp_path / "state" / "stamp"

    def needed(content: str, *, done: bool = True) -> bool:
        source.write_text(content)
        with steps.step("a step", stamp, steps.digest([source], "fact"), done=done) as answer:
            return bool(answer)

    assert needed("one")
    assert not needed("one")
    assert needed("two")
    assert needed("two", done=False)
    assert not needed("two")
    with pytest.raises(RuntimeError), steps.step("fails", stamp, steps.digest([source])):
        raise RuntimeError
    assert needed("two"), "a failed step must not count as done"


def test_what_studies_need_stays_and_nothing_is_installed_twice(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """`uv pip sync` removes what no lock names: it is given theirs once they were installed."""
    asked: list[list[str]] = []
    monkeypatch.setattr(packages, "VENV", tmp_path)
    monkeypatch.setattr(packages, "venv_python", lambda: "3.11")
    monkeypatch.setattr(packages, "setup_uv", lambda: "uv")
    monkeypatch.setattr(
        packages, "run", lambda *command: asked.append([str(each) for each in command])
    )
    monkeypatch.setattr(packages, "pip_install", lambda *words: asked.append([*map(str, words)]))

    def locks_of_set_up() -> list[str]:
        asked.clear()
        packages.setup_python(packages.LOCKS[:1])
        return [Path(each).name for each in asked[0] if each.endswith(".lock")] if asked else []

    assert locks_of_set_up() == ["requirements.lock"]
    assert locks_of_set_up() == []
    packages.setup_studies()
    assert asked[0] == ["-r", str(ROOT / "requirements-studies.lock")]
    assert locks_of_set_up() == []
    (tmp_path / ".locked").write_text("another lock than today's")
    assert locks_of_set_up() == ["requirements.lock", "requirements-studies.lock"]
    assert locks_of_set_up() == []


def test_renaming_a_source_changes_the_hash(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(steps, "ROOT", tmp_path)
    first, second = tmp_path / "a", tmp_path / "b"
    first.write_text("same")
    before = steps.digest([first])
    first.rename(second)
    assert steps.digest([second]) != before


@pytest.mark.parametrize(
    ("arguments", "says"),
    [(["frobnicate"], "knows no 'frobnicate'"), (["setup", "x"], "takes no arguments")],
)
def test_dev_says_in_one_line_what_is_wrong(arguments: list[str], says: str) -> None:
    answer = run(sys.executable, ROOT / "dev", *arguments)
    assert answer.returncode == 1
    assert says in answer.stderr
    assert len(answer.stderr.splitlines()) == 1


def test_up_tells_at_once_that_the_port_is_taken() -> None:
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = str(taken.getsockname()[1])
        answer = run(sys.executable, ROOT / "dev", "up", "--port", port)
    assert answer.returncode == 1
    assert f"port {port}" in answer.stderr
    assert len(answer.stderr.splitlines()) == 1


def test_missing_node_is_replaced_only_when_missing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name, text in (("node", "#!/bin/sh\necho v18.19.0\n"), ("npm", "#!/bin/sh\n")):
        (tmp_path / name).write_text(text)
        (tmp_path / name).chmod(0o755)
    monkeypatch.setenv("PATH", str(tmp_path))
    assert running.node_version() == (18, 19, 0)
    assert running.node_version() < running.NODE_MINIMUM
    (tmp_path / "npm").unlink()
    assert running.node_version() == ()


@pytest.mark.parametrize("status", [0, 1])
def test_ci_passes_the_exit_status_on_and_ends_with_pytests_closing_line(
    tmp_path: Path, status: int
) -> None:
    closing = "===== 1 failed, 41 passed, 1 skipped in 63.20s (0:01:03) ====="
    (tmp_path / ".ci").mkdir()
    shutil.copy(ROOT / ".ci" / "run", tmp_path / ".ci" / "run")
    (tmp_path / "dev").write_text(f'#!/bin/sh\necho "{closing}"\necho later\nexit {status}\n')
    (tmp_path / "dev").chmod(0o755)
    answer = run("bash", ".ci/run", cwd=tmp_path, stdin=subprocess.DEVNULL)
    assert answer.returncode == status
    assert answer.stdout.splitlines()[-1] == closing
