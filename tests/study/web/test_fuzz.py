"""Whatever strangers, a participant or the experimenter send to any address, the server does not fail."""

from __future__ import annotations

import httpx
import schemathesis
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from study.responses import Submission
from study.web.app import create_app
from study.web.server import running
from study.web.site import Site


def test_nothing_that_is_sent_makes_the_server_fail(site: Site) -> None:
    app = create_app(site)
    with running(app) as address, httpx.Client(base_url=address) as client:
        client.post("/start")
        client.post("/consent", data={"agreed": "yes", "language": "en"})
        experimenter = site.credentials.cookie("edit", site.clock())
        known = f"participant={client.cookies['participant']}; experimenter={experimenter}"
    description = app.openapi()
    submission = Submission.model_json_schema(ref_template="#/components/schemas/{model}")
    description["components"]["schemas"] |= submission.pop("$defs")
    content = {"application/json": {"schema": submission}}
    description["paths"]["/study/answers"] = {"post": {"requestBody": {"content": content}, "responses": {}}}
    schema = schemathesis.openapi.from_dict(description)
    operations = [found.ok() for found in schema.get_all_operations()]
    cases = st.one_of([operation.as_strategy() for operation in operations if "live" not in operation.path])

    @settings(max_examples=120, suppress_health_check=list(HealthCheck))
    @given(case=cases, cookies=st.sampled_from(["", known]))
    def check(case: schemathesis.Case, cookies: str) -> None:
        app.state.limits = type(app.state.limits)()  # nobody is slowed down
        response = case.call(app=app, headers={"Cookie": cookies})
        assert response.status_code < 500, f"{case.method} {case.path}"

    check()
