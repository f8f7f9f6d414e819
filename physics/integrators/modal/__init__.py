"""The modal method: the linear part solved exactly in modes, one adaptive march, one file a concern.

Read them in this order:

- `flow`: the linear part in modes; `remainder`: what the contact force is more than that; `error_growth`: what becomes
  of an error
- what a step needs: `phi`, `weights` (made of them), `layout` (where they lie), `tables` (of whole units), `between`
  (of all other lengths), `reading`
- steps: `rk4` knows no step before it, `carried` goes on from its past
- how long they are: `judgement`, `bumps` (what a step does not see of a path), `choice`
- contact: `changes` (who may change sides), `location` (when), `approach` (the way there), `grazing` (touches between
  the instants of a step), `tension` (how long balls touch, and how long the film pulls)
- `memory` (what a march remembers), `modal_march`, `samples` (what it writes)
"""
