"""Code that users bring, and what may be wrong with it."""

import sys

import pytest
from command_line import run

from datagen.errors import BadInput
from datagen.judging.user_code import load_user_code, user_code

BROKEN = {
    "h_syntax": "def broken(:\n",
    "h_raises": "raise RuntimeError('not today')\n",
    "h_leaves": "import sys\nsys.exit(3)\n",
    "h_thing": "class Thing:\n    def __init__(self, size):\n        self.size = size\n",
    "h_refuses": "class Thing:\n    def __init__(self):\n        raise KeyError('no')\n",
}


@pytest.fixture
def here(tmp_path, monkeypatch):
    """The working folder of a user, with modules of their own, from a path that does not name it."""
    for name, text in BROKEN.items():
        (tmp_path / f"{name}.py").write_text(text)
    (tmp_path / "h_good.py").write_text("class Thing:\n    size = 3\ndef function(table):\n    return table\n")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "path", [entry for entry in sys.path if entry])
    return tmp_path


def test_a_class_is_made_and_a_function_is_taken_from_the_working_folder(here):
    assert load_user_code("h_good:Thing", "").size == 3
    assert load_user_code("h_good:function", "")(4) == 4


@pytest.mark.parametrize(
    "name", [*(f"{module}:Thing" for module in BROKEN), ":X", "X:", "numpy", "", "nowhere:X", "h_good:Other", "..:X"]
)
def test_what_cannot_be_loaded_is_refused_with_what_can(here, name):
    with pytest.raises(BadInput, match=r"--estimator.*module:Class"):
        load_user_code(name, "module:Class")


def test_a_module_that_is_not_there_is_told_without_a_place_inside_python(here):
    with pytest.raises(BadInput, match=r"No module named 'nowhere'; allowed"):
        load_user_code("nowhere:X", "module:Class")


@pytest.mark.parametrize("name", ["h_thing:Thing", "h_good:Other"])
def test_no_place_in_our_code_is_told_as_theirs(here, name):
    with pytest.raises(BadInput, match=r"(argument: 'size'|attribute 'Other'); allowed"):
        load_user_code(name, "module:Class")


def test_the_place_in_their_code_is_told(here):
    with pytest.raises(BadInput, match=r"KeyError: 'no' \(.*h_refuses\.py, line 3\)"):
        load_user_code("h_refuses:Thing", "module:Class")


@pytest.mark.parametrize("command", [["classify", "--train", "a", "--test", "b"], ["size", "a"]])
def test_both_commands_refuse_it_alike(here, command):
    done = run(*command, "--estimator", "h_syntax:Thing")
    assert done.exit_code == 2
    assert "--estimator" in done.output
    assert "h_syntax.py" in done.output


def test_a_name_that_ends_with_its_colon_is_no_name_of_anything(here):
    with pytest.raises(BadInput) as refused:
        load_user_code("h_good:", "module:Class")
    assert str(refused.value) == '--estimator = "h_good:"; allowed: module:Class'


def test_the_working_folder_goes_before_all_other_places(here, monkeypatch):
    (here / "other").mkdir()
    (here / "other" / "h_twice.py").write_text("where = 'other'\n")
    (here / "h_twice.py").write_text("where = 'here'\n")
    monkeypatch.syspath_prepend(here / "other")
    assert load_user_code("h_twice:where", "") == "here"


def test_a_place_beside_our_code_is_told():
    with (
        pytest.raises(BadInput, match=r"it fails: KeyError: 'no' \(.*test_user_code\.py, line \d+\)"),
        user_code("a:A", "it fails"),
    ):
        raise KeyError("no")
