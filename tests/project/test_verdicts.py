"""The README, and the verdicts at the top of the pages of scores, quote the tables of these pages."""

import re
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple

import pytest

ROOT = Path(__file__).resolve().parents[2]
DOCS = ROOT / "docs"


def verdict(page):
    text = (DOCS / page).read_text(encoding="utf-8")
    return text.split("## Should I trust it, and for what?\n")[1].split("\n## ")[0]


SAID = {
    name: " ".join(text.split())
    for name, text in {
        "README": (ROOT / "README.md").read_text(encoding="utf-8"),
        "size.md": verdict("size.md"),
        "transfer.md": verdict("transfer.md"),
    }.items()
}


@pytest.mark.parametrize("page", ["size.md", "transfer.md"])
def test_every_decimal_of_the_verdict_stands_in_a_table_of_the_page(page):
    text = (DOCS / page).read_text(encoding="utf-8")
    tables = "".join(re.findall(r"<!-- [^>]*: begin .*?: end -->", text, re.DOTALL))
    figures = re.findall(r"\d+\.\d+", verdict(page))
    assert len(figures) > 8
    assert [figure for figure in figures if figure not in re.findall(r"\d+\.\d+", tables)] == []


# Ways to read a cell like "0.936 (0.886 to 0.980)", "7.4 (5.4–9.5)", "3.7 (1.6)" or "17 of 132 [0.077, 0.198]".
ALL, FIRST, IN_BRACKETS = r"[\d.]+", r"^[\d.]+", r"\(([\d.]+)\)"
OF_132, OF_78, OF_640 = r"^\d+(?= of 132)", r"^\d+(?= of 78)", r"^\d+(?= of 640)"
LEARNERS, FOUND = "(forest|logistic|boosting)", "(outer and inner, )?without odd ones"
LEVELS, NOISY = "clean|20|10|5|0", "(20|10|5|0) dB"
PAGES = {
    "scores": "transfer.md",
    "draws": "transfer.md",
    "crossfitted": "transfer.md",
    "conditions": "transfer.md",
    "noise": "transfer.md",
    "size ladder": "size.md",
    "speeds": "charts/README.md",
}


class Claim(NamedTuple):
    """A sentence whose number all cells round to, or whose two numbers are the smallest and the largest.

    `table` stands on its page between marks. `row` and `column` are patterns: of the cells that a row begins with, and
    of a column's name. What is read from a cell counts `scale` times. `where` the sentence stands: in the README, or in
    the verdict of a page.
    """

    sentence: str
    table: str
    row: tuple[str, ...]
    column: str
    reading: str
    scale: float = 1.0
    where: str = "README"


CLAIMS = (
    Claim("solvers run at {} to {} times", "speeds", ("G1|F1",), "SciPy solver", FIRST),
    Claim("compiled throughout at {} to {} (", "speeds", ("G1|F1",), "compiled solver, .*", FIRST),
    Claim("three odd records: {} % are found", "scores", ("cwru_de12k", LEARNERS), FOUND, FIRST, 100.0),
    Claim("{} % again with each of five draws", "draws", ("cwru_de12k", LEARNERS), FOUND, ALL, 100.0),
    Claim("without learning finds {} %", "scores", ("cwru_de12k", "rule"), FOUND, FIRST, 100.0),
    Claim("{} % with each draw", "draws", ("cwru_de12k", "rule"), FOUND, ALL, 100.0),
    Claim("{} to {} of the 132 in that do", "scores", ("transfer", LEARNERS), "false alarms", OF_132),
    Claim("of other machines, {} to {} do.", "crossfitted", (LEARNERS,), "false alarms", OF_640),
    Claim("{} to {} of 78", "scores", ("corpus", LEARNERS), "false alarms", OF_78),
    Claim("{} to {} % of clean records", "size ladder", ("no estimate, load given",), "clean", FIRST),
    Claim("{} to {} % of noisy ones", "size ladder", ("no estimate, load given",), NOISY, FIRST),
    Claim("wrong by {} to {} % in the mean", "size ladder", ("arc error, load and.*",), f"clean|{NOISY}", FIRST),
    Claim("release and regain by {} to {} %", "size ladder", ("lag error",), f"clean|{NOISY}", FIRST),
    Claim("medians are {} to {} %", "size ladder", ("noise, dB", LEVELS), "arc error.*", IN_BRACKETS),
    Claim("% and {} to {} %. It has not", "size ladder", ("noise, dB", LEVELS), "lag error.*", IN_BRACKETS),
)

FRESH, BLIND, MEAN_LAG, MEAN_ARC = "fresh ladder", "fresh ladder, blind", "lag error.*", "arc error.*"
OF_ALL, NOISE_ADDED, AT_THE_ALARM = "outer and inner, all records", "noise", ".*at the alarm"


def size_verdict(sentence, row, column, reading=FIRST):
    return Claim(sentence, "size ladder", row, column, reading, where="size.md")


def transfer_verdict(sentence, table, row, column, reading=FIRST):
    return Claim(sentence, table, row, column, reading, where="transfer.md")


VERDICTS = (
    size_verdict("arc of clean records is wrong by {} % in", ("noise, dB", "clean"), MEAN_ARC),
    size_verdict("in the mean and by {} % in the median, at", ("noise, dB", "clean"), MEAN_ARC, IN_BRACKETS),
    size_verdict("at 10 dB by {} % and", ("noise, dB", "10"), MEAN_ARC),
    size_verdict("% and {} %. That is far better", ("noise, dB", "10"), MEAN_ARC, IN_BRACKETS),
    size_verdict("{} % of the clean records with a spall", ("no estimate, clean",), FRESH),
    size_verdict("above 800 N {} %", ("load, N", "over 800"), "no estimate"),
    size_verdict("on the mfpt rig {} %", ("rig", "mfpt"), "no estimate"),
    size_verdict("At 20 dB the lag is wrong by {} % in", ("noise, dB", "20"), MEAN_LAG),
    size_verdict("in the mean but by {} % in the median", ("noise, dB", "20"), MEAN_LAG, IN_BRACKETS),
    size_verdict("hold {} % of the true lags", ("90 % interval of the lag holds the truth",), FRESH),
    size_verdict("{} % of the true arcs", ("90 % interval of the arc holds the truth",), FRESH),
    size_verdict("For {} % of the records without an event", ("abstention where there is no event",), FRESH),
    size_verdict("Blind, {} % of clean records get no size", ("no estimate, clean",), BLIND),
    size_verdict("so their error of {} %", ("arc error, clean",), BLIND),
    transfer_verdict("Every learner scores {} on `mfpt`", "scores", ("mfpt", LEARNERS), OF_ALL),
    transfer_verdict("and {} on `cwru_de12k` (", "scores", ("cwru_de12k", LEARNERS), OF_ALL),
    transfer_verdict("({} without three odd records)", "scores", ("cwru_de12k", LEARNERS), "without odd ones"),
    transfer_verdict("The rule scores {} and", "scores", ("mfpt", "rule"), OF_ALL),
    transfer_verdict("and {}; the difference on `cwru_de12k`", "scores", ("cwru_de12k", "rule"), OF_ALL),
    transfer_verdict("the difference on `cwru_de12k` is {} [", "scores", ("cwru_de12k", LEARNERS), "minus rule"),
    transfer_verdict("of other machines, {} to {} do.", "crossfitted", (LEARNERS,), "false alarms", OF_640),
    transfer_verdict("learners tell roughly: {} to {} on", "conditions", (LEARNERS,), "healthy, line and extended"),
    transfer_verdict("the forest scores {}, the rule", "scores", ("corpus", "forest"), OF_ALL),
    transfer_verdict("the rule {}; at −13 dB", "scores", ("corpus", "rule"), OF_ALL),
    transfer_verdict("on `cwru_de12k` it scores {},", NOISE_ADDED, ("cwru_de12k", "-13", "forest"), AT_THE_ALARM),
    transfer_verdict("the rule {}. In less noise", NOISE_ADDED, ("cwru_de12k", "-13", "rule"), AT_THE_ALARM),
    transfer_verdict("through another sensor: {} by the rule", "draws", ("cwru_fe12k", "rule"), FOUND, ALL),
    transfer_verdict("every learner scores {} on `cwru_de12k`", "draws", ("cwru_de12k", LEARNERS), FOUND, ALL),
    transfer_verdict(
        "the forest scores {} on `cwru_de12k`", NOISE_ADDED, ("cwru_de12k", "-16", "forest"), AT_THE_ALARM
    ),
)


def numbers(claim):
    """What stands in the rows and columns that a claim quotes."""
    text = (DOCS / PAGES[claim.table]).read_text(encoding="utf-8")
    marked = text.split(f"<!-- {claim.table}: begin ")[1].split(f"<!-- {claim.table}: end -->")[0]
    lines = [[cell.strip() for cell in line.split("|")[1:-1]] for line in marked.splitlines()]
    head: list[str] = []
    for row, following in pairwise([*lines, []]):
        if following[:1] == ["---"]:
            head = row
        elif len(row) == len(head) and all(map(re.fullmatch, claim.row, row)):
            chosen = [cell for name, cell in zip(head, row, strict=True) if re.fullmatch(claim.column, name)]
            yield from (claim.scale * float(number) for cell in chosen for number in re.findall(claim.reading, cell))


@pytest.mark.parametrize("claim", CLAIMS + VERDICTS, ids=lambda claim: claim.sentence)
def test_a_figure_quotes_its_table(claim):
    said = re.findall(re.escape(claim.sentence).replace(r"\{\}", r"([\d.]+)"), SAID[claim.where])
    assert len(said) == 1, f"{claim.where} says this {len(said)} times"
    low, high = said[0] if isinstance(said[0], tuple) else said * 2
    found = list(numbers(claim))
    for stated, measured in ((low, min(found)), (high, max(found))):
        last_digit = 10.0 ** -len(stated.partition(".")[2])
        assert abs(float(stated) - measured) <= 0.5 * last_digit + 1e-9, f"{stated} stands for {measured:g}"
