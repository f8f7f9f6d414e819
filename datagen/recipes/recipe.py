"""A recipe: everything a person says of a corpus, checked; the same recipe always gives the same corpus."""

from __future__ import annotations

import hashlib
import json
from functools import cached_property
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import Field, PrivateAttr, ValidationError, model_validator

from datagen.distributions.kinds import Distribution, Fixed
from datagen.errors import BadInput
from datagen.recipes.accuracy_settings import AccuracySettings
from datagen.recipes.background_settings import BackgroundSettings
from datagen.recipes.chain_settings import ChainSettings
from datagen.recipes.defect_settings import DefectSettings
from datagen.recipes.imperfection_settings import ImperfectionSettings
from datagen.recipes.machine_settings import MachineSettings
from datagen.recipes.operation_settings import OperationSettings
from datagen.recipes.profile_table import FOLDER
from datagen.recipes.recipe_files import find_recipe
from datagen.recipes.record_order import Place, machines, place_by_part, place_interleaved
from datagen.recipes.sampling_limits import require_sampled_fast_enough
from datagen.recipes.signal_settings import Signal
from datagen.recipes.split_settings import Split
from datagen.recipes.store_settings import Store
from datagen.settings.problems import bad_settings
from datagen.settings.table import CorpusName, OneOf, PartName, Prose, Table, named_differently, refuse
from datagen.settings.toml_file import read_toml
from physics.words import CONTACT_LAWS

LARGEST_HYPERCUBE = 50_000
Count = Annotated[int, Field(ge=1, le=10_000_000)]


class Part(Table):
    """A number of records drawn alike, on virtual machines of their own."""

    name: PartName
    """Name of the part, stored with each of its records."""
    records: Count
    """Number of records."""
    records_per_machine: Count = 1
    """Records made on each virtual machine, with the same bearing, imperfections and noise floor."""
    design: Literal["random", "latin_hypercube", "sobol"] = "random"
    """How the drawn settings are spread: freely, or evenly over their joint space."""
    contact_law: Annotated[Distribution, OneOf(CONTACT_LAWS)] = Fixed("paper")
    """paper: the oil film may pull a ball; no_tension: it may not."""
    machine: MachineSettings
    """The virtual machines."""
    operation: OperationSettings = OperationSettings()
    """How they are run."""
    defect: DefectSettings | None = None
    """Their state of health; healthy if not given."""
    imperfections: ImperfectionSettings = ImperfectionSettings()
    """What their bearings lack."""
    chain: ChainSettings | None = None
    """Their measurement chain; the recipe's if not given."""
    background: BackgroundSettings | None = None
    """Their noise and other layers; the recipe's if not given."""

    @model_validator(mode="after")
    def _leaves_room_for_damage(self) -> Part:
        if self.defect is not None and self.defect.healthy_records > self.records_per_machine:
            most = f"at most {self.records_per_machine}, the records of each machine"
            raise refuse("a machine has fewer records", "defect.healthy_records", most)
        return self

    @model_validator(mode="after")
    def _can_have_its_spalls(self) -> Part:
        if self.defect is not None:
            self.defect.check_against_bearings(self.machine.most_rows, self.machine.ball_counts)
        return self

    @model_validator(mode="after")
    def _small_enough_a_hypercube(self) -> Part:
        if self.design == "latin_hypercube" and self.records > LARGEST_HYPERCUBE:
            raise refuse(f"a Latin hypercube holds at most {LARGEST_HYPERCUBE} records; sobol any number", "design")
        return self

    @property
    def machines(self) -> int:
        """Number of virtual machines."""
        return machines((self.records, self.records_per_machine))


class Recipe(Table):
    """A corpus before it is drawn: `load_recipe` reads one from a TOML file."""

    name: CorpusName
    """Name of the corpus: letters, digits, - and _."""
    title: Prose = ""
    """One line for people."""
    summary: Prose = ""
    """A few sentences for people."""
    licence: Prose = ""
    """Terms of use of the corpus."""
    citation: Prose = ""
    """How its makers want to be cited."""
    seed: Annotated[int, Field(ge=0, le=2**63 - 1)]
    """Seed of every random number."""
    signal: Signal
    """How records are sampled."""
    chain: ChainSettings = ChainSettings()
    """Measurement chain of every part that says nothing of its own."""
    background: BackgroundSettings = BackgroundSettings()
    """Background of every part that says nothing of its own."""
    accuracy: AccuracySettings = AccuracySettings()
    """How exactly records are simulated."""
    store: Store = Store()
    """What is written."""
    split: Split = Split()
    """How virtual machines are divided."""
    order: Literal["by_part", "interleaved"] = "by_part"
    """by_part: one part after the other; interleaved: taking turns, so that the first records are of all parts."""
    part: tuple[Part, ...] = Field(min_length=1, strict=False)
    """The parts of the corpus, in order."""

    _source: str = PrivateAttr(default="")

    @model_validator(mode="after")
    def _distinct_names(self) -> Recipe:
        named_differently(self.part, "part")
        return self

    def chain_of(self, part: Part) -> ChainSettings:
        """Measurement chain of one of its parts."""
        return part.chain or self.chain

    def background_of(self, part: Part) -> BackgroundSettings:
        """Background of one of its parts."""
        return part.background or self.background

    @property
    def drawable(self) -> bool:
        """True if every recording that its scenarios take stretches of is at hand: a manifest only describes them."""
        tables = [self.background, *(part.background for part in self.part)]
        return all(table is None or table.recording is None or table.recording.at_hand for table in tables)

    @property
    def source(self) -> str:
        """The file it was read from, for messages."""
        return self._source

    @cached_property
    def hash(self) -> str:
        """Hex SHA-256 of everything that was read, defaults and tables included; comments and layout do not count."""
        content = json.dumps(self.model_dump(mode="json"), sort_keys=True, separators=(",", ":"))
        return hashlib.sha256(content.encode()).hexdigest()

    @property
    def short_hash(self) -> str:
        """The first 16 digits of the hash, by which a corpus knows the recipe that made it."""
        return self.hash[:16]

    @property
    def count(self) -> int:
        """Number of records of all parts."""
        return sum(part.records for part in self.part)

    def require(self, record: int, asked_by: str = "record") -> None:
        """Raise BadInput, with `asked_by` as its field, if there is no such `record`."""
        if not 0 <= record < self.count:
            raise BadInput(file=self.source, field=asked_by, value=record, allowed=f"0 to {self.count - 1}")

    def place(self, record: int) -> Place:
        """Where `record` (0 ≤ record < count) stands in the corpus."""
        self.require(record)
        sizes = tuple((part.records, part.records_per_machine) for part in self.part)
        return place_by_part(sizes, record) if self.order == "by_part" else place_interleaved(sizes, record)


def load_recipe(path_or_name: str | Path) -> Recipe:
    """The recipe in a file, in a folder's `recipe.toml` or of a dataset that comes with spallgen; raises BadInput."""
    path = find_recipe(path_or_name)
    content, text = read_toml(path)
    if "recording" in content and "part" not in content:
        problem = "this is a SPEC of recordings, which `spallgen import` brings in, and no recipe"
        raise BadInput(problem, file=str(path), field="recording", allowed="[[part]]")
    return parse_recipe(content, path, text)


def parse_recipe(content: dict[str, Any], path: Path, text: str = "") -> Recipe:
    """The recipe of parsed TOML read from `path`; raises BadInput, with line numbers where `text` is given."""
    wrong = None
    try:
        recipe = Recipe.model_validate(content, context={FOLDER: path.parent})
    except ValidationError as error:
        wrong = bad_settings(error, Recipe, path, text)
    if wrong is not None:  # raised out here it has no context, which would not survive a way between processes
        raise wrong
    recipe._source = str(path)
    require_sampled_fast_enough(recipe, path, text)
    return recipe
