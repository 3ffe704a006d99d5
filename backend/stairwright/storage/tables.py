"""The tables. A change here needs a new file in migrations/versions."""

from __future__ import annotations

from sqlalchemy import Index
from sqlalchemy.orm import DeclarativeBase, Mapped, mapped_column


class Base(DeclarativeBase):
    """Base of all tables; times are seconds since 1970."""


class SavedTerrain(Base):
    """A terrain of the user's."""

    __tablename__ = "terrains"

    name: Mapped[str] = mapped_column(primary_key=True)
    document: Mapped[str]  # JSON
    updated: Mapped[float]


class SavedRobot(Base):
    """A robot of the user's."""

    __tablename__ = "robots"

    name: Mapped[str] = mapped_column(primary_key=True)
    document: Mapped[str]  # JSON
    updated: Mapped[float]


class StoredDocument(Base):
    """A plan or a rollout; its content lies among the artefacts.

    `question` is a hash of everything that was asked, `engine` one of the code that answered: with
    both alike the answer is the same.
    """

    __tablename__ = "documents"
    __table_args__ = (
        Index("documents_by_question", "question", "engine"),
        Index("documents_by_use", "used"),
    )

    id: Mapped[str] = mapped_column(primary_key=True)
    kind: Mapped[str]
    question: Mapped[str]
    engine: Mapped[str]
    digest: Mapped[str] = mapped_column(index=True)
    size: Mapped[int]  # bytes on disk
    summary: Mapped[str]  # JSON
    created: Mapped[float]
    used: Mapped[float]
    name: Mapped[str] = mapped_column(server_default="")  # the user's
    note: Mapped[str] = mapped_column(server_default="")
    pinned: Mapped[bool] = mapped_column(server_default="0")  # stays when room is made


class StoredJob(Base):
    """A job's latest known state."""

    __tablename__ = "jobs"

    id: Mapped[str] = mapped_column(primary_key=True)
    kind: Mapped[str]
    state: Mapped[str]
    result: Mapped[str | None]
    error: Mapped[str | None]  # JSON, a problem document
    created: Mapped[float] = mapped_column(index=True)
    updated: Mapped[float] = mapped_column(index=True)
    question: Mapped[str | None] = mapped_column(index=True)  # None when finished
    owner: Mapped[str] = mapped_column(server_default="")
    deaths: Mapped[int] = mapped_column(server_default="0")  # of workers at it
    losses: Mapped[int] = mapped_column(server_default="0")  # of the service while it ran
    revision: Mapped[int] = mapped_column(server_default="1")


class JobQuestion(Base):
    """What unfinished jobs ask, once for all that ask the same."""

    __tablename__ = "job_questions"

    key: Mapped[str] = mapped_column(primary_key=True)
    document: Mapped[str]  # JSON
    needs: Mapped[str | None]  # digest of the artefact that it refers to


class StoredStudy(Base):
    """A study; its cells lie in a Zarr group of its own."""

    __tablename__ = "studies"

    id: Mapped[str] = mapped_column(primary_key=True)
    name: Mapped[str]
    document: Mapped[str]  # JSON, names resolved
    engine: Mapped[str]  # fingerprint of the code that its cells are by
    state: Mapped[str]
    error: Mapped[str | None]  # JSON, a problem document
    owner: Mapped[str]
    done: Mapped[int]  # cells
    total: Mapped[int]
    size: Mapped[int]  # bytes on disk
    losses: Mapped[int]  # of whoever was at it
    created: Mapped[float]
    used: Mapped[float] = mapped_column(index=True)


class IdempotencyRecord(Base):
    """What a request with an Idempotency-Key led to."""

    __tablename__ = "idempotency"

    scope: Mapped[str] = mapped_column(primary_key=True)
    key: Mapped[str] = mapped_column(primary_key=True)
    fingerprint: Mapped[str]
    result: Mapped[str | None]  # None while the first request is at work
    created: Mapped[float]
