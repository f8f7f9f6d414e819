"""A scene without any change of contact, in which every method shows its order."""

import dataclasses
from collections.abc import Callable

from physics.scene import Scene


def always_in_contact(reference_scene: Callable[[str, float], Scene], duration: float) -> Scene:
    """G1 with preload, which keeps every ball in contact over a shallow spall."""
    scene = reference_scene("G1", duration)
    bearing = dataclasses.replace(scene.rig.bearing, clearance=-15e-6)
    shallow = dataclasses.replace(scene.spalls[0], depth=4e-6)
    return dataclasses.replace(scene, rig=dataclasses.replace(scene.rig, bearing=bearing), spalls=(shallow,))
