"""What the texts below the settings of a table say of them."""

from __future__ import annotations

import ast
import inspect
import textwrap
from itertools import pairwise

from pydantic import BaseModel


def setting_docstrings(table: type[BaseModel]) -> dict[str, str]:
    """The docstring of each setting of a `table`, its parents' too.

    pydantic can read them itself (`use_attribute_docstrings`), but does so whenever a program starts, and only the
    schema asks for them.
    """
    found: dict[str, str] = {}
    for parent in reversed([kind for kind in table.__mro__ if issubclass(kind, BaseModel) and kind is not BaseModel]):
        definitions = ast.walk(ast.parse(textwrap.dedent(inspect.getsource(parent))))
        body = next(node.body for node in definitions if isinstance(node, ast.ClassDef))
        for setting, below in pairwise(body):
            match setting, below:
                case ast.AnnAssign(target=ast.Name(id=name)), ast.Expr(value=ast.Constant(value=str(words))):
                    found[name] = inspect.cleandoc(words)
    return found
