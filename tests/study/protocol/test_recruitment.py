from __future__ import annotations

import pytest
from pydantic import ValidationError

from study.protocol.recruitment import Recruitment


@pytest.mark.parametrize(
    "address",
    [
        "https://app.prolific.com/submissions/complete?cc=C1A2B3",
        "https://uni.sona-systems.com/webstudy_credit.aspx?experiment_id=1&survey_code={id}",
        "https://worker.mturk.com",
    ],
)
def test_the_services_addresses_are_known(address: str) -> None:
    assert Recruitment(completion_url=address).completion_url == address


@pytest.mark.parametrize(
    "address",
    [
        "http://app.prolific.com/",
        "https://evil.example/?app.prolific.com",
        "https://app.prolific.com.evil.example/",
        "https://sona-systems.com.evil.example/",
        "https://evilsona-systems.com/",
        "https://app.prolific.com@evil.example/",
        "https://evil.example\\@app.prolific.com/",
        "javascript:alert(1)",
        "//evil.example",
    ],
)
def test_nobody_is_sent_anywhere_else(address: str) -> None:
    with pytest.raises(ValidationError, match=r"completion_url"):
        Recruitment(completion_url=address)


def test_a_gap_that_nothing_fills_is_refused() -> None:
    with pytest.raises(ValidationError, match=r"has {pid}, which stands for nothing; did you mean id\?"):
        Recruitment(completion_url="https://app.prolific.com/done?cc={pid}")


def test_another_host_can_be_allowed_by_name() -> None:
    address = "https://panel.example/done?id={id}&code={code}"
    allowed = Recruitment(completion_url=address, hosts=("panel.example",))
    filled = allowed.completion_address(external_id="a&b=/", code="K3-M")
    assert filled == "https://panel.example/done?id=a%26b%3D%2F&code=K3-M"
    assert Recruitment().completion_address(external_id=None, code="K") is None
