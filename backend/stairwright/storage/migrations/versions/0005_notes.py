"""What users say of results: a name, a note, and that one is to be kept."""

import sqlalchemy as sa
from alembic import op

revision = "0005"
down_revision = "0004"


def upgrade() -> None:
    """Results from before have neither name nor note, and are not pinned."""
    with op.batch_alter_table("documents") as documents:
        documents.add_column(sa.Column("name", sa.String(), nullable=False, server_default=""))
        documents.add_column(sa.Column("note", sa.String(), nullable=False, server_default=""))
        documents.add_column(sa.Column("pinned", sa.Boolean(), nullable=False, server_default="0"))
