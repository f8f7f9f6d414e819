"""Numerical methods for the equations of motion: one method, one file.

- `method`: what each of them states of itself; `methods`: the table of all
- `modal/`: the default, which chooses its own steps
- fixed steps: `exponential_rk4`, `exponential_adams`, `runge_kutta4`, `generalised_alpha`; `march` takes them
- adaptive steps: `dormand_prince`; `dormand_prince_march` takes them
- what they are made of: `propagator` (the linear part solved exactly), `accelerations`, `contact_tangent`
- contact: `trial` (a step not yet taken), `events` (a change of contact inside it), `stops` (kinks known beforehand)
- `output`: what every march fills
- to compare with: `reference/` (slow and independent), `rivals/` (solvers as others would pick them)
"""
