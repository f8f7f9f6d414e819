"""The slow reference method and equations of its own, which share no kernel with the methods held against it."""
