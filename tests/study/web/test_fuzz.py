"""Whatever is sent to any address, the server does not fail."""

from __future__ import annotations

import schemathesis
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from study.web.app import create_app
from study.web.site import Site


def test_nothing_that_is_sent_makes_the_server_fail(site: Site) -> None:
    app = create_app(site)
    schema = schemathesis.openapi.from_dict(app.openapi())
    operations = [found.ok() for found in schema.get_all_operations()]
    cases = st.one_of([operation.as_strategy() for operation in operations if "live" not in operation.path])

    @settings(max_examples=150, suppress_health_check=list(HealthCheck))
    @given(case=cases)
    def check(case: schemathesis.Case) -> None:
        app.state.limits = type(app.state.limits)()  # nobody is slowed down
        response = case.call(app=app)
        assert response.status_code < 500, f"{case.method} {case.path}"

    check()
