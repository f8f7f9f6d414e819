"""Question 2: do unequal balls give the cage-frequency sidebands that the paper measured and could not predict?"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.figure import Figure

from datagen.drawing.style import EXTENDED, GREY, INK, LINE, faint_grid
from datagen.paper.chapter import Chapter, Row, beside, only_ours
from datagen.paper.figure08_velocity_spectra import HARMONICS, SIXTH
from datagen.paper.panels import heading, highest_near, letter, power_decibel, spread
from datagen.paper.scenes import (
    ANALYSED,
    RATE,
    SHOWN_SEED,
    bpfo_hz,
    ftf_hz,
    machine,
    scene,
    signal,
    wavy_extended_spall,
)
from labels.density import velocity_density
from physics.arrays import Array
from physics.imperfections import Imperfections
from physics.reference_scenes import line_spall
from physics.scene import Scene

if TYPE_CHECKING:
    from matplotlib.axes import Axes


NAME = "question2"
DEVIATIONS_UM = (0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0)
# Those that the table has with 1 % slip too.
WITH_SLIP_UM = (0.5, 2.0, 5.0)
DRAWS = 5
# Key of the diameters' random numbers, which are not those of the slip of the same seed.
BALLS = 1
SHOWN_DEVIATION, SMALL_DEVIATION = 0.5, 0.2
MICRON = 1e-6
REACH = 0.4
SPAN = 25.0
VISIBLE = (-20.0, -10.0)  # dB re the harmonic
COLOURS = {"line": LINE, "extended": EXTENDED}


@dataclass(frozen=True)
class Sidebands:
    """Cage sidebands over their BPFO harmonic, dB: (deviations, draws, 13) for a steady cage and one that slips 1 %.

    `deviations_um`: standard deviations of the balls' diameters, µm.
    """

    deviations_um: tuple[float, ...]
    steady: Array
    slipping: Array

    def sixth(self, slipping: bool = False) -> Array:
        """Of the sixth harmonic (deviations, draws), dB."""
        return (self.slipping if slipping else self.steady)[:, :, SIXTH - 1]


def unequal(deviation_um: float, seed: int) -> Imperfections:
    """Balls whose diameters have exactly this standard deviation (µm) about the nominal one, drawn by `seed`."""
    bearing = machine("gearbox").bearing
    stream = np.random.default_rng(np.random.SeedSequence(seed, spawn_key=(BALLS,)))
    drawn = stream.standard_normal((bearing.rows, bearing.balls))
    drawn = (drawn - drawn.mean()) / drawn.std() * deviation_um * MICRON
    return Imperfections(ball_deviation=tuple(tuple(float(value) for value in row) for row in drawn))


def machine_state(condition: str, deviation_um: float, seed: int, slip: bool) -> Scene:
    """The gearbox rig with a line or extended spall and unequal balls."""
    spall = line_spall("gearbox") if condition == "line" else wavy_extended_spall(SHOWN_SEED)
    balls = unequal(deviation_um, seed) if deviation_um > 0.0 else None
    return scene("gearbox", spall, slip_seed=seed if slip else None, imperfections=balls)


def sidebands(acceleration: Array, orders: tuple[int, ...] = (1,)) -> Array:
    """Strongest sideband at these multiples of the cage frequency over each of the 13 BPFO harmonics, dB (velocity)."""
    frequency, power = velocity_density(acceleration, RATE, 1.0 / ANALYSED)
    level = power_decibel(power)
    centres = bpfo_hz("gearbox") * np.arange(1, HARMONICS + 1)
    carrier = highest_near(frequency, level, list(centres), 1.5)[1]
    away = [side * order * ftf_hz("gearbox") for order in orders for side in (-1, 1)]
    beside_it = [highest_near(frequency, level, list(centres + shift), REACH)[1] for shift in away]
    return np.asarray(np.max(beside_it, axis=0) - carrier)


def strongest_of_all(condition: str) -> Array:
    """Strongest of the first five cage sidebands of the sixth harmonic, dB (DRAWS,): shown deviation, no slip."""
    states = (machine_state(condition, SHOWN_DEVIATION, seed, False) for seed in range(DRAWS))
    return np.array([sidebands(signal(state), (1, 2, 3, 4, 5))[SIXTH - 1] for state in states])


def measure(condition: str, deviations: tuple[float, ...] = DEVIATIONS_UM, draws: int = DRAWS) -> Sidebands:
    """Sidebands of a condition for every deviation and draw."""

    def all_of(slip: bool) -> Array:
        return np.array(
            [
                [sidebands(signal(machine_state(condition, deviation, seed, slip))) for seed in range(draws)]
                for deviation in deviations
            ]
        )

    return Sidebands(deviations, all_of(False), all_of(True))


def chapter() -> Chapter:
    """Question 2 with its table."""
    found = {condition: measure(condition) for condition in COLOURS}
    floor = {condition: measure(condition, (0.0,)) for condition in COLOURS}
    return Chapter(
        NAME,
        "Question 2: do unequal balls give the cage-frequency sidebands?",
        "Gearbox rig, 7 Hz, 346 N, 1.4 s; ball diameters drawn with the stated standard "
        "deviation over both rows, five draws each; the stronger of the two sidebands one "
        "cage frequency beside a BPFO harmonic of the velocity, relative to that harmonic. " + answer(found, floor),
        tuple(rows(found, floor)),
        lambda: draw(found, floor),
    )


def answer(found: dict[str, Sidebands], floor: dict[str, Sidebands]) -> str:
    """What came out, in words."""
    needed = {name: deviation_for(measured, VISIBLE[0]) for name, measured in found.items()}
    hidden = float(np.median(floor["extended"].sixth(slipping=True)))
    small = float(np.median(found["extended"].sixth()[DEVIATIONS_UM.index(SMALL_DEVIATION)]))
    return (
        f"Yes. They grow in proportion to the deviation, lie at {small:.0f} dB of the sixth harmonic for "
        f"{SMALL_DEVIATION:g} µm (extended) and reach {VISIBLE[0]:.0f} dB at {needed['line']:.2g} µm (line) and "
        f"{needed['extended']:.2g} µm (extended). Slip of 1 % alone puts {hidden:.0f} dB there, so with that slip they "
        f"show as lines of their own only at deviations above {deviation_for(found['extended'], hidden):.2g} µm: balls "
        "that differ by tenths of a micrometre do not explain measured sidebands under that much slip."
    )


def deviation_for(found: Sidebands, level: float) -> float:
    """Deviation (µm) at which the steady cage's sidebands of the sixth harmonic reach `level` (dB), median draw.

    By a line through the first five deviations; larger balls bend the springs.
    """
    medians = np.median(found.sixth(), axis=1)
    slope, offset = np.polyfit(np.log10(found.deviations_um)[:5], medians[:5], 1)
    return float(10.0 ** ((level - offset) / slope))


def rows(found: dict[str, Sidebands], floor: dict[str, Sidebands]) -> list[Row]:
    """The table of question 2."""
    table = []
    for condition, measured in found.items():
        equal, slipping = (float(np.median(floor[condition].sixth(slip))) for slip in (False, True))
        table.append(only_ours(f"equal balls, steady cage, {condition}", equal, "dB", "leakage of the window"))
        for k, deviation in enumerate(DEVIATIONS_UM):
            level = measured.sixth()[k]
            title = f"sideband of the sixth harmonic, {deviation:g} µm, {condition}"
            each = np.median(measured.steady[k], axis=0)
            comment = f"{spread(level)}; all 13 harmonics {each.min():.0f} to {each.max():.0f}"
            seen = bool(np.median(level) > equal + 6.0)
            table.append(beside(NAME, "sidebands", title, float(np.median(level)), comment, agrees=seen, unit="dB"))
        every = strongest_of_all(condition)
        title = f"strongest of five cage sidebands, {SHOWN_DEVIATION:g} µm, {condition}"
        table.append(only_ours(title, float(np.median(every)), "dB", spread(every)))
        for level in VISIBLE:
            title = f"deviation for {level:.0f} dB, {condition}"
            table.append(
                only_ours(title, deviation_for(measured, level), "µm", "line through the five smallest deviations")
            )
        table.append(only_ours(f"equal balls, 1 % slip, {condition}", slipping, "dB", "flank of the smeared harmonic"))
        for deviation in WITH_SLIP_UM:
            level = measured.sixth(slipping=True)[DEVIATIONS_UM.index(deviation)]
            title = f"{deviation:g} µm and 1 % slip, {condition}"
            table.append(only_ours(title, float(np.median(level)), "dB", spread(level)))
    return table


def draw(found: dict[str, Sidebands], floor: dict[str, Sidebands]) -> Figure:
    """Sideband level against deviation on the left; spectra around the sixth harmonic on the right."""
    figure = Figure(figsize=(11.0, 6.4))
    grid = figure.add_gridspec(2, 2, left=0.065, right=0.985, top=0.865, bottom=0.085, wspace=0.15, hspace=0.38)
    curve = figure.add_subplot(grid[:, 0])
    _draw_growth(curve, found, floor)
    letter(curve, "a", "Cage sidebands of the sixth harmonic")
    for place, (slip, title) in enumerate(
        ((False, "Around the sixth harmonic, no slip"), (True, "The same, 1 % slip"))
    ):
        axes = figure.add_subplot(grid[place, 1])
        _draw_spectra(axes, slip)
        letter(axes, "bc"[place], title)
        if place == 0:
            axes.legend(loc="upper right", frameon=True, edgecolor="none", framealpha=1.0)
        else:
            axes.set_xlabel("frequency (Hz)")
    heading(
        figure,
        "Question 2: do unequal balls give cage-frequency sidebands?",
        "gearbox rig, 7 Hz, 346 N, 1.4 s; deviation: standard deviation of the balls' diameters; dotted: sixth "
        "harmonic ± whole cage frequencies",
    )
    return figure


def _draw_growth(axes: Axes, found: dict[str, Sidebands], floor: dict[str, Sidebands]) -> None:
    for condition, sidebands in found.items():
        colour = COLOURS[condition]
        level = sidebands.sixth()
        axes.semilogx(
            DEVIATIONS_UM, np.median(level, axis=1), "o-", color=colour, markersize=4, label=f"{condition}, no slip"
        )
        axes.fill_between(DEVIATIONS_UM, level.min(axis=1), level.max(axis=1), color=colour, alpha=0.13, linewidth=0)
        slipping = np.median(sidebands.sixth(slipping=True), axis=1)
        axes.semilogx(
            DEVIATIONS_UM, slipping, "s--", color=colour, markersize=3.5, linewidth=0.9, label=f"{condition}, 1 % slip"
        )
        equal = float(np.median(floor[condition].sixth(slipping=True)))
        axes.axhline(equal, color=colour, linewidth=0.7, linestyle=":")
    axes.plot([], [], ":", color=GREY, label="equal balls, 1 % slip")
    axes.set_xticks(DEVIATIONS_UM, [f"{deviation:g}" for deviation in DEVIATIONS_UM])
    axes.minorticks_off()
    axes.set(xlabel="deviation of the balls' diameters (µm)", ylabel="dB re the harmonic")
    axes.legend(loc="lower right")
    faint_grid(axes)


def _draw_spectra(axes: Axes, slip: bool) -> None:
    centre, ftf = SIXTH * bpfo_hz("gearbox"), ftf_hz("gearbox")
    for k in np.arange(-8, 9):
        axes.axvline(centre + k * ftf, color=GREY, linewidth=0.6, linestyle=":", zorder=0)
    for deviation, colour, name in ((SHOWN_DEVIATION, EXTENDED, f"{SHOWN_DEVIATION:g} µm"), (0.0, INK, "equal balls")):
        found = signal(machine_state("extended", deviation, SHOWN_SEED, slip))
        frequency, power = velocity_density(found, RATE, 1.0 / ANALYSED)
        near = np.abs(frequency - centre) < SPAN
        axes.plot(frequency[near], power_decibel(power[near]), color=colour, linewidth=1.0, label=name)
    axes.set(xlim=(centre - SPAN, centre + SPAN), ylim=(-175.0, -75.0), ylabel="dB re 1 (m/s)²/Hz")
    faint_grid(axes)
