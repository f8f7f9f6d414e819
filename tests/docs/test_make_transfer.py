"""Cells of the tables of docs/transfer.md."""

from pathlib import Path

import pytest
from make_transfer import main
from transfer_page import calibration

from datagen.errors import BadInput
from labels.classifier.scores import FEWEST_A_SIDE


@pytest.mark.parametrize(("faults", "cell"), [(FEWEST_A_SIDE, "0.123"), (FEWEST_A_SIDE - 1, "–")])
def test_a_calibration_error_needs_healthy_records_and_faults_of_the_races_wherever_they_stand(faults, cell):
    confusion = {"rows": ["inner", "ball", "none", "outer"], "counts": [[0, 1], [0, 50], [99, 0], [faults - 1, 0]]}
    assert calibration({"healthy": 99, "confusion": confusion, "calibration_error": 0.1234}) == cell
    assert calibration({"healthy": 99, "confusion": confusion}) == "–"


def test_draws_alone_are_no_report():
    with pytest.raises(BadInput, match="no report of the main run; allowed: its report"):
        main([Path("draws.json")])
