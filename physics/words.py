"""Words of scenes and results that other packages need, in a room that loads neither scipy nor the compiler."""

from __future__ import annotations

CONTACT_LAWS = ("paper", "no_tension")
# Elements of the symmetric stiffness matrix, in the order in which they are kept.
STIFFNESS_COMPONENTS = ("xx", "yy", "xy")
