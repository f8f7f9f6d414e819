"""Models of one scene from the cheapest to the full one: one model, one file, each with its known range.

- `impulse_train`, `quasi_static`, `linear_time_varying`, in this order; the full one is physics.simulate itself
- `model`: what each of them states of itself; `model_table`: all by name
- `contact_sets`: changes of contact read from who touches at each sample
"""
