"""Robots that users saved."""

import sqlalchemy as sa
from alembic import op

revision = "0003"
down_revision = "0002"


def upgrade() -> None:
    """They are kept as terrains are."""
    op.create_table(
        "robots",
        sa.Column("name", sa.String(), primary_key=True),
        sa.Column("document", sa.String(), nullable=False),
        sa.Column("updated", sa.Float(), nullable=False),
    )
