"""HTML: templates filled in, in one language, with the protocol's texts as sanitised Markdown."""

from __future__ import annotations

import hashlib
from functools import cache, lru_cache, partial
from pathlib import Path
from typing import Any

import nh3
from fastapi import FastAPI, Request
from fastapi.responses import HTMLResponse
from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markdown_it import MarkdownIt
from markupsafe import Markup

import study.questions
from study.questions import Question
from study.web.language import load_language
from study.web.site import Site

HERE = Path(__file__).parent
STATIC = HERE / "static"
QUESTIONS = Path(study.questions.__file__).parent

_environment = Environment(
    loader=FileSystemLoader([HERE / "templates", QUESTIONS]),
    autoescape=True,
    undefined=StrictUndefined,
    auto_reload=False,
    trim_blocks=True,
    lstrip_blocks=True,
)
_markdown = MarkdownIt("commonmark").enable("table")


_template = cache(_environment.get_template)


@cache
def prose(markdown: str) -> Markup:
    """Markdown as HTML, with everything taken out that could run or load something."""
    return Markup(nh3.clean(_markdown.render(markdown), tags=nh3.ALLOWED_TAGS - {"img"}, link_rel="noopener"))


@cache
def static_version() -> str:
    """Hash of all static files. It stands in their addresses, so that a browser may keep them for ever."""
    contents = b"".join(file.read_bytes() for file in sorted(STATIC.iterdir()))
    return hashlib.sha256(contents).hexdigest()[:12]


def asset(name: str) -> str:
    """The address of a static file."""
    return f"/static/{static_version()}/{name}"


@lru_cache(maxsize=2048)
def ask(
    language: str,
    question: Question,
    number: int,
    items: tuple[str, ...] = (),
    options: tuple[str, ...] = (),
) -> Markup:
    """A question as HTML, by the template beside its kind."""
    shown = items or tuple(question.items)
    template = _template(question.template)
    spoken = load_language(language)
    return Markup(
        template.render(
            question=question,
            number=number,
            language=language,
            items=shown,
            options=options,
            _=spoken.text,
            figure=spoken.number,
        )
    )


@lru_cache(maxsize=2048)
def url(app: FastAPI, page: str, /, **parts: str) -> str:
    """The address of a page."""
    return str(app.url_path_for(page, **parts))


@lru_cache(maxsize=32)
def _shared(app: FastAPI, language: str) -> dict[str, Any]:
    """What all pages in one language are filled in with."""
    site: Site = app.state.site
    return {
        "_": load_language(language).text,
        "language": language,
        "languages": {code: load_language(code).name for code in site.protocol.languages},
        "study_title": site.protocol.title.in_(language),
        "contact": site.protocol.contact,
        "texts": {name: text.in_(language) for name, text in site.protocol.texts},
        "prose": prose,
        "asset": asset,
        "url": partial(url, app),
        "ask": partial(ask, language),
        "kind": site.kind,
        "door": site.door,
    }


def fill(app: FastAPI, template: str, *, language: str, **values: Any) -> str:
    """A page as HTML."""
    return _template(template).render(_shared(app, language) | values)


def render(
    request: Request, template: str, *, language: str, status: int = 200, **values: Any
) -> HTMLResponse:
    """A page."""
    return HTMLResponse(fill(request.app, template, language=language, **values), status_code=status)
