"""Scores are kept by the names of folders, so these must differ."""

from pathlib import Path

import make_draws
import make_transfer
import pytest
import transfer_page

from datagen.errors import BadInput


def test_two_corpora_of_one_name_are_refused_before_anything_is_learned(tmp_path):
    with pytest.raises(BadInput, match="several folders are called so"):
        make_draws.main(tmp_path / "train", tmp_path / "draws.json", [Path("a/corpus"), Path("b/corpus")])
    assert list(tmp_path.iterdir()) == []


def test_two_reports_in_folders_of_one_name_are_refused(tmp_path):
    with pytest.raises(BadInput, match="main"):
        make_transfer.main([tmp_path / "a" / "main" / "report.json", tmp_path / "b" / "main" / "report.json"])


def test_folders_of_different_names_are_fine():
    transfer_page.require_different_names([Path("a/corpus"), Path("a/other")])
