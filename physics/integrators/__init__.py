"""Numerical methods for the equations of motion: one method, one file.

- `method`: what each of them states of itself; `method_table`: all by name
- `modal/`: the default, which chooses its own steps
- fixed steps: `exponential_rk4`, `exponential_adams`, `runge_kutta4`, `generalised_alpha`, taken by `fixed_step_march`
- adaptive steps: `dormand_prince`, taken by `dormand_prince_march`
- what they are made of: `propagator` (the linear part solved exactly), `accelerations`, `contact_tangent`
- contact: `trial` (a step not yet taken), `events` (a change of contact inside it), `state_contact` (who touches in a
  state), `stops` (kinks known beforehand)
- `output`: what every march fills
- to compare with: `reference/` (slow and independent), `rivals/` (solvers as others would pick them)
"""
