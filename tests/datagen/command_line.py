"""How tests run a command of the program in their own process."""

from typing import NamedTuple

from typer.testing import CliRunner

from datagen.cli import app


class Ended(NamedTuple):
    """How a command ended: its exit code and what it wrote to standard output and to standard error."""

    exit_code: int
    stdout: str
    stderr: str

    @property
    def output(self) -> str:
        """All that it wrote, standard output first."""
        return self.stdout + self.stderr


def run(*arguments: object) -> Ended:
    """Run the command with these arguments; raises what it does not turn into an exit code."""
    done = CliRunner().invoke(app, [str(argument) for argument in arguments], catch_exceptions=False)
    return Ended(done.exit_code, done.stdout, done.stderr)
