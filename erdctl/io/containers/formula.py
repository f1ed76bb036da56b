"""A conversion that a file states as text, `X1 * 0.5 + 3`, as arithmetic and nothing else.

    formula := numbers, X or X1 (the stored value), pi
               + - * / ** and brackets, the functions of FUNCTIONS

Everything is computed in float64, so that no formula grows without end. `^`, `%` and operations on
bits are refused: between the tools that write them they mean different things.
"""

from __future__ import annotations

import ast
from collections.abc import Callable
from typing import Any

import numpy as np

from erdctl.core.messages import counted
from erdctl.core.recording import Array

LONGEST = 1000  # characters; those of benches have fewer than 100
DEEPEST = 40  # brackets within brackets
_NESTED = 400  # operations within operations: X1+X1+...

FUNCTIONS: dict[str, tuple[int, Callable[..., Any]]] = {
    "sin": (1, np.sin),
    "cos": (1, np.cos),
    "tan": (1, np.tan),
    "asin": (1, np.arcsin),
    "arcsin": (1, np.arcsin),
    "acos": (1, np.arccos),
    "arccos": (1, np.arccos),
    "atan": (1, np.arctan),
    "arctan": (1, np.arctan),
    "sinh": (1, np.sinh),
    "cosh": (1, np.cosh),
    "tanh": (1, np.tanh),
    "exp": (1, np.exp),
    "ln": (1, np.log),
    "log10": (1, np.log10),
    "sqrt": (1, np.sqrt),
    "abs": (1, np.abs),
    "pow": (2, np.power),
}
_BINARY: dict[type, Callable[..., Any]] = {
    ast.Add: np.add,
    ast.Sub: np.subtract,
    ast.Mult: np.multiply,
    ast.Div: np.divide,
    ast.Pow: np.power,
}
_UNSURE = {
    ast.BitXor: "'^' (a power to some tools, an exclusive or to others; write pow(a, b))",
    ast.Mod: "'%' (its sign differs between tools)",
    "log": "'log' (natural to some tools, decimal to others; write ln or log10)",
}


class WrongFormula(Exception):
    """A formula that is not evaluated; says why."""


def evaluated(formula: str, values: Array) -> Array:
    """The formula of (n,) stored values, in float64.

    Raises WrongFormula where it is no arithmetic, is too long, or gives no number for a value.
    Check: "2*X1 + 1" of 3 is 7; "pow(X, 2)/4" of 6 is 9.
    >>> evaluated("2*X1 + 1", np.array([3.0])).tolist()
    [7.0]
    >>> evaluated("pow(X, 2)/4", np.array([6.0])).tolist()
    [9.0]
    """
    tree = parsed(formula)
    raw = np.asarray(values, np.float64)
    with np.errstate(all="ignore"):
        found = np.broadcast_to(np.asarray(_value(tree, raw), np.float64), raw.shape)
    lost = ~np.isfinite(found) & np.isfinite(raw)
    if lost.any():
        at = int(lost.argmax())
        raise WrongFormula(f"it gives no number for the stored value {raw[at]:g} (row {at + 1})")
    return np.array(found)


def parsed(formula: str) -> ast.expr:
    """The syntax tree of a formula that is arithmetic. Raises WrongFormula."""
    text = formula.strip().rstrip("\0").strip().casefold()
    if not text:
        raise WrongFormula("it is empty")
    if len(text) > LONGEST:
        raise WrongFormula(f"it has {len(text)} characters; at most {LONGEST} are evaluated")
    deep = 0
    for letter in text:
        deep += {"(": 1, "[": 1, "{": 1, ")": -1, "]": -1, "}": -1}.get(letter, 0)
        if deep > DEEPEST:
            raise WrongFormula(f"its brackets are more than {DEEPEST} deep")
    try:
        tree = ast.parse(text, mode="eval").body
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        raise WrongFormula("it is no formula") from None
    _check(tree, 0)
    return tree


def _check(node: ast.expr, depth: int) -> None:
    if depth > _NESTED:
        raise WrongFormula(f"it nests more than {_NESTED} operations")
    if isinstance(node, ast.Constant):
        if isinstance(node.value, bool) or not isinstance(node.value, (int, float)):
            raise WrongFormula(f"it holds {ast.unparse(node)[:40]}, which is no number")
        return None
    if isinstance(node, ast.Name):
        if node.id not in ("x", "x1", "pi"):
            raise WrongFormula(f"it needs '{node.id[:40]}', which is not the stored value X1")
        return None
    if isinstance(node, ast.UnaryOp) and isinstance(node.op, (ast.UAdd, ast.USub)):
        return _check(node.operand, depth + 1)
    if isinstance(node, ast.BinOp) and type(node.op) in _BINARY:
        _check(node.left, depth + 1)
        return _check(node.right, depth + 1)
    if isinstance(node, ast.BinOp) and type(node.op) in _UNSURE:
        raise WrongFormula(f"it uses {_UNSURE[type(node.op)]}")
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and not node.keywords:
        name = node.func.id
        if name in _UNSURE:
            raise WrongFormula(f"it uses {_UNSURE[name]}")
        arguments, _ = FUNCTIONS.get(name, (len(node.args), None))
        if name in FUNCTIONS and len(node.args) == arguments:
            for argument in node.args:
                _check(argument, depth + 1)
            return None
        raise WrongFormula(
            f"it calls '{name[:40]}' with {counted(len(node.args), 'value')}, which is unknown"
        )
    raise WrongFormula("it holds more than arithmetic")


def _value(node: ast.expr, raw: Array) -> Any:
    if isinstance(node, ast.Constant):
        assert isinstance(node.value, (int, float))
        return np.float64(node.value)
    if isinstance(node, ast.Name):
        return np.pi if node.id == "pi" else raw
    if isinstance(node, ast.UnaryOp):
        value = _value(node.operand, raw)
        return -value if isinstance(node.op, ast.USub) else value
    if isinstance(node, ast.BinOp):
        return _BINARY[type(node.op)](_value(node.left, raw), _value(node.right, raw))
    assert isinstance(node, ast.Call)
    assert isinstance(node.func, ast.Name)
    _, function = FUNCTIONS[node.func.id]
    return function(*(_value(argument, raw) for argument in node.args))
