"""What a job needs to go on after a restart: its question, its owner, and how often it was lost."""

import sqlalchemy as sa
from alembic import op

revision = "0002"
down_revision = "0001"


def upgrade() -> None:
    """Jobs from before have no question: they are told to have been interrupted."""
    op.create_table(
        "job_questions",
        sa.Column("key", sa.String(), primary_key=True),
        sa.Column("document", sa.String(), nullable=False),
        sa.Column("needs", sa.String(), nullable=True),
    )
    with op.batch_alter_table("jobs") as jobs:
        jobs.add_column(sa.Column("question", sa.String(), nullable=True))
        jobs.add_column(sa.Column("owner", sa.String(), nullable=False, server_default=""))
        jobs.add_column(sa.Column("deaths", sa.Integer(), nullable=False, server_default="0"))
        jobs.add_column(sa.Column("losses", sa.Integer(), nullable=False, server_default="0"))
        jobs.add_column(sa.Column("revision", sa.Integer(), nullable=False, server_default="1"))
        jobs.create_index("ix_jobs_question", ["question"])
        jobs.create_index("ix_jobs_created", ["created"])
