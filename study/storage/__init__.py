"""Where sessions and responses are kept: one file per kind of database, chosen by the URL.

`open_store("sqlite:///data/study.db")` or `open_store("postgresql://…")`; the store speaks SQLAlchemy Core
and is the same for all.
"""

from __future__ import annotations

import importlib
import pkgutil

from sqlalchemy import make_url
from sqlalchemy.exc import ArgumentError, DBAPIError

from stimuli.errors import InputError
from study.storage.database import Database
from study.storage.store import Store

__all__ = ["Store", "databases", "open_store"]

NOT_DATABASES = {"archive", "backups", "database", "migrations", "store", "tables", "writer"}


def databases() -> tuple[str, ...]:
    """Kinds of database known here, by the scheme of their URL."""
    names = (module.name for module in pkgutil.iter_modules(__path__))
    return tuple(sorted(name for name in names if name not in NOT_DATABASES))


def open_store(url: str) -> Store:
    """Open the store at a database URL, making its tables where there are none."""
    try:
        parsed = make_url(url)
    except ArgumentError as err:
        raise InputError(f"{url!r} is not a database URL. Try sqlite:///data/study.db.") from err
    kind = parsed.get_backend_name()
    if kind not in databases():
        raise InputError(f"{url!r}: {kind!r} databases are not known. Known: {', '.join(databases())}.")
    database: Database = importlib.import_module(f"{__name__}.{kind}").open_database(parsed)
    try:
        return Store(database)
    except DBAPIError as err:
        raise InputError(f"{parsed}: cannot be opened: {' '.join(str(err.orig).split())}") from err
