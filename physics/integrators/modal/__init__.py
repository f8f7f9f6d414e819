"""The modal method: the linear part in modes, one adaptive march, one file a concern."""
