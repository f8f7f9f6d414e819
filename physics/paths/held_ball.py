"""A ball on its race, and what holds it: a place between points that were tried, a lip, or the higher of two bumps."""

from __future__ import annotations

import math
from typing import NamedTuple, Protocol

import numpy as np

from physics.arrays import Array, Index
from physics.bearing import Bearing

# What rounding leaves of a height (m).
HEIGHT_ROUNDING = 1e-15
# How often the two spaces beside a point of the surface are halved, and then cut where a straight line between their
# ends says that the ball touches.
HALVINGS, CUTS = 3, 3
# Halvings that find an angle to its last digit.
AWAY_HALVINGS = 60
# Share of its radius by which a ball may touch beside its centre.
FARTHEST = 1.0 - 1e-12


class Surface(Protocol):
    """Depth of a surface (m, positive where material is missing) against the arc (rad) from the spall's centre, or its
    slope (m/rad) where `order` is 1."""

    def __call__(self, arc: Array, order: int = 0) -> Array: ...


class Held(NamedTuple):
    """What holds a ball at each arc (N,): the `place` (rad) where it touches, the `depth` (m) of the surface there, and
    the `drop` (m) of the ball."""

    place: Array
    depth: Array
    drop: Array

    def take(self, at: Index, other: Held, deeper: float) -> int:
        """At the arcs numbered `at` (N,), take over what holds the ball there by `other` where its drop exceeds the
        present one by less than `deeper` (m); how many were taken over."""
        holds = other.drop < self.drop[at] + deeper
        for mine, found in zip(self, other, strict=True):
            mine[at[holds]] = found[holds]
        return int(np.count_nonzero(holds))


class Ball(NamedTuple):
    """A ball and the race it rolls on: both radii (m), and `turn`, 1 where the race bends away from the ball, as the
    inner one does, and −1 where it bends towards it."""

    race_radius: float
    ball_radius: float
    turn: float

    @property
    def half_arc(self) -> float:
        """Half the arc (rad) of the race that the ball covers: no contact lies farther ahead of it."""
        return math.asin(min(1.0, self.ball_radius / self.race_radius))

    def _lever(self, depth: Array, away: Array) -> tuple[Array, Array, Array]:
        """Of contacts with the surface at `depth` (N,), m, that lie `away` (N,), rad, ahead of the ball: the radius of
        the contact, its offset to the side of the ball's centre, and its distance from there along the radius, m."""
        radius = self.race_radius - self.turn * depth
        longest = self.ball_radius * FARTHEST
        lever = np.clip(radius * np.sin(away), -longest, longest)
        return radius, lever, np.sqrt(self.ball_radius**2 - lever**2)

    def drop(self, depth: Array, away: Array) -> Array:
        """Drop (N,) of its centre, m; infinite where it is too far away to touch there."""
        radius, lever, hanging = self._lever(depth, away)
        drop = self.turn * (self.race_radius - radius * np.cos(away)) + self.ball_radius - hanging
        return np.where(np.abs(lever) < self.ball_radius * FARTHEST, drop, math.inf)

    def slope(self, depth: Array, away: Array) -> Array:
        """Slope (N,) of its path, m/rad."""
        radius, lever, hanging = self._lever(depth, away)
        return -radius * (self.turn * np.sin(away) + np.cos(away) * lever / hanging)

    def gain(self, depth: Array, steepness: Array, away: Array) -> Array:
        """How much deeper (N,), m/rad, it would lie if it touched farther ahead on a surface of this `steepness` (N,),
        m/rad; zero where it touches."""
        _, lever, hanging = self._lever(depth, away)
        sinking = np.cos(away) - self.turn * np.sin(away) * lever / hanging
        return steepness * sinking - self.slope(depth, away)

    def away_on(self, depth: Array, steepness: Array) -> Array:
        """How far ahead (N,), rad, it touches a surface at `depth` (N,), m, that is so steep (N,), m/rad, there."""
        least = np.full(depth.shape, -self.half_arc)
        most = -least
        for _ in range(AWAY_HALVINGS):
            middle = 0.5 * (least + most)
            ahead = self.gain(depth, steepness, middle) < 0.0
            least, most = np.where(ahead, middle, least), np.where(ahead, most, middle)
        return 0.5 * (least + most)

    def drop_from_edge(self, arc: Array) -> Array:
        """Drop (N,), m, of the ball hanging on one sharp edge at the arcs ψ (N,), rad, from it.

        Outer race: Rb − √(Rb² − Ro² sin²ψ) − Ro (1 − cos ψ); inner race: the last term is + Ri (1 − cos ψ).
        """
        lever = np.minimum(self.race_radius * np.sin(arc), self.ball_radius)
        hanging = self.ball_radius - np.sqrt(self.ball_radius**2 - lever**2)
        return np.asarray(hanging + self.turn * self.race_radius * (1.0 - np.cos(arc)))

    def slope_from_edge(self, arc: Array) -> Array:
        """Slope (N,), m/rad, of that drop."""
        lever = np.minimum(self.race_radius * np.sin(arc), self.ball_radius * FARTHEST)
        hanging = lever * self.race_radius * np.cos(arc) / np.sqrt(self.ball_radius**2 - lever**2)
        return np.asarray(hanging + self.turn * self.race_radius * np.sin(arc))

    def reach_from_edge(self, drop: float) -> float:
        """Arc (rad) from a sharp edge at which the ball hanging on it has dropped by `drop` (m).

        No more than the arc at which it slips past the edge.
        """
        race_radius, ball_radius = self.race_radius, self.ball_radius
        furthest = self.half_arc
        drop = min(drop, ball_radius + self.turn * race_radius * (1.0 - math.cos(furthest)))
        centre_radius = race_radius + self.turn * (ball_radius - drop)
        half_sine = math.sqrt(drop * (2.0 * ball_radius - drop) / (4.0 * race_radius * centre_radius))
        return min(furthest, 2.0 * math.asin(half_sine))

    def on(self, surface: Surface, place: Array, arc: Array) -> Held:
        """The ball at the arcs (N,), rad, that touches the surface at the places (N,), rad."""
        depth = surface(place)
        return Held(place, depth, self.drop(depth, place - arc))


def ball_of(bearing: Bearing, race: str) -> Ball:
    """A ball of the `bearing` on its "outer" or "inner" race."""
    return Ball(bearing.raceway_radius(race), bearing.ball_radius, -1.0 if race == "outer" else 1.0)


def between_points(surface: Surface, ball: Ball, arc: Array, place: Array, apart: float) -> Held:
    """The ball at the arcs (N,), rad, where it touches the surface no farther than `apart` (rad) from the places (N,),
    rad, or at these if it would fall from both sides."""

    def gain(place: Array) -> Array:
        return ball.gain(surface(place), surface(place, 1), place - arc)

    left, right = place - apart, place + apart
    low, high = gain(left), gain(right)
    between = (low < 0.0) & (high > 0.0)
    touching = place
    for cut in range(HALVINGS + CUTS):
        share = 0.5 if cut < HALVINGS else low / np.where(between, low - high, 1.0)
        touching = left + (right - left) * share
        found = gain(touching)
        ahead = found < 0.0
        left, low = np.where(ahead, touching, left), np.where(ahead, found, low)
        right, high = np.where(ahead, right, touching), np.where(ahead, high, found)
    return ball.on(surface, np.where(between, touching, place), arc)


def hold_between_points(surface: Surface, ball: Ball, arc: Array, held: Held, apart: float) -> None:
    """Let balls touch the surface between its points, `apart` (rad), beside those that hold them."""
    held.take(np.arange(arc.size), between_points(surface, ball, arc, held.place, apart), HEIGHT_ROUNDING)


def hold_as_neighbours(surface: Surface, ball: Ball, arc: Array, held: Held, apart: float, leap: float) -> None:
    """Let balls beside a corner of the path, where the place leaps by more than `leap` (rad), touch the bump that holds
    their neighbours, where that holds them higher: of two bumps, points of the surface, `apart` (rad), may show the
    lower one as the higher."""
    for _ in range(arc.size):
        corners = np.flatnonzero(np.abs(np.diff(held.place)) > leap)
        moved = 0
        for at, neighbour in ((corners, corners + 1), (corners + 1, corners)):
            found = between_points(surface, ball, arc[at], held.place[neighbour], apart)
            moved += held.take(at, found, -HEIGHT_ROUNDING)
        if moved == 0:
            return


def hold_on_lips(surface: Surface, ball: Ball, arc: Array, held: Held, lips: Array, reach: float) -> None:
    """Let balls at evenly spaced arcs (N,), rad, touch `lips` (L,), rad, within `reach` (rad), where these hold them
    higher."""
    step = (arc[-1] - arc[0]) / (arc.size - 1)
    for lip, depth in zip(lips, surface(lips), strict=True):
        first = max(0, math.ceil((lip - reach - arc[0]) / step))
        last = min(arc.size - 1, math.floor((lip + reach - arc[0]) / step))
        near = np.arange(first, last + 1)
        place, depths = np.full(near.size, lip), np.full(near.size, depth)
        held.take(near, Held(place, depths, ball.drop(depths, place - arc[near])), 0.0)
