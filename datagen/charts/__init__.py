"""Speed against accuracy: methods, models and general-purpose solvers run on one scene and measured."""
