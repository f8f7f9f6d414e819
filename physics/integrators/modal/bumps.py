"""What a carried step does not see of a rolled path: bumps between the three instants at which it meets the force.

Over a rough surface a ball changes from bump to bump. Every corner that this makes is a step's end, but where the
bumps are close together the path bends between corners as sharply. The force then swings faster than its values at the
beginning, in the middle and at the end of a step show; slopes and depths of the path there together do show it.
"""

from __future__ import annotations

from physics._jit import njit_inline, njit_inner
from physics.arrays import Array
from physics.contact.contact_set import NOTED_COMPRESSION
from physics.contact.forces import ACTIVE, COMPRESSION, Contacts, law_power
from physics.contact.track import CAGE, RELIEF, Track, passage, path_under, place_of
from physics.paths.depth_path import PIECES

# Error of a step, over its length, in terms of how far the middle strays from the cubic of values and rates at both
# ends.
HERMITE_ERROR = 2.0 / 15.0
# A smooth path has two edges and a floor; one of more pieces has corners where the ball changes from bump to bump.
SMOOTH_PIECES = 3.0


@njit_inner
def has_corners(track: Track) -> bool:
    """Whether some path has corners on its floor."""
    bumpy = False
    for spall in range(track.spalls.shape[0]):
        bumpy = bumpy or _has_corners(track, spall)
    return bumpy


@njit_inline
def _has_corners(track: Track, spall: int) -> bool:
    return track.spalls[spall, RELIEF] > 0.0 and track.paths.places[spall, PIECES] > SMOOTH_PIECES


@njit_inner
def passed_over(contacts: Contacts, noted: Array, time: float, step: float) -> float:
    """Momentum (N s) by which a `step` (s) from `time` (s) on is wrong about the paths of the balls that touch; `noted`
    (G, 2, M) is their motion at its beginning.

    As `resolution_error` measures it of a whole motion: of the film, Simpson's rule on the path's slopes against its
    depths; of the elastic contact, how far its middle is from the cubic through depths and slopes at both ends.
    """
    balls, track, law = contacts.balls, contacts.track, contacts.law
    total = 0.0
    for spall in range(track.spalls.shape[0]):
        if not _has_corners(track, spall):
            continue
        cage = int(track.spalls[spall, CAGE])
        travel, arc, turns, leave = passage(track, spall, time, step)
        while arc <= leave:
            place = place_of(track, spall, turns)
            if balls[cage, ACTIVE, place] > 0.5:
                begin, slope = path_under(track, spall, arc)
                middle, middle_slope = path_under(track, spall, arc + 0.5 * travel)
                final, final_slope = path_under(track, spall, arc + travel)
                film = final - begin - travel / 6.0 * (slope + 4.0 * middle_slope + final_slope)
                astray = middle - 0.5 * (begin + final) - 0.125 * travel * (slope - final_slope)
                pressed = law_power(law, max(noted[cage, NOTED_COMPRESSION, place], balls[cage, COMPRESSION, place]))
                stiffness = law.stiffness * law.exponent * pressed
                total += abs(law.damping * film) + HERMITE_ERROR * step * stiffness * abs(astray)
            arc += track.spacing
            turns += 1.0
    return total
