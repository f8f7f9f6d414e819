"""The slow reference method, which shares no kernel with the methods held against it.

`equations`: of motion, ball by ball; `integrate`: SciPy's DOP853 on them.
"""
