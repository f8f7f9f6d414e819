"""Speed against accuracy: methods, models and general-purpose solvers run on one scene and measured.

- `scenes`: which scene; `contestants`: what is run on it; `response`: what each gives back
- `measure`: all of them timed and held against the reference, by `response_errors`; `table`: the outcome
- `stability`: maps of where each method fails
"""
