"""One file a command. Heavy packages are imported inside the commands, so that help comes at once."""
