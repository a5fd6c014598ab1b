"""`study new` writes a study that is ready as it is."""

import pytest

from stimuli.errors import InputError
from study.check import check
from study.new import new_study
from study.protocol import load_protocol


def test_a_new_study_is_ready_as_it_is(tmp_path):
    protocol = load_protocol(new_study(tmp_path / "wave pilot"))
    assert protocol.study == "wave-pilot"
    report = check(protocol)
    assert report.good, str(report)
    assert {finding.verdict for finding in report.findings} == {"good"}, str(report)
    assert (protocol.folder / "protocol.schema.json").is_file()


def test_a_folder_with_something_in_it_is_left_alone(tmp_path):
    (tmp_path / "notes.txt").write_text("mine")
    with pytest.raises(InputError, match="not empty"):
        new_study(tmp_path)
