"""Solvers as others would pick or write them: measured beside this package's methods, no record is made by them.

`ball_by_ball`: the equations in one flat loop; `general_purpose`: compiled solvers that locate no change of contact.
"""
