"""The web application: participants' pages, the experimenter's page, and the server they run on."""

from __future__ import annotations

from study.web.app import create_app
from study.web.server import Links, serve

__all__ = ["Links", "create_app", "serve"]
