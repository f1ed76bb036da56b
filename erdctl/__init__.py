"""erdctl: identify, simulate, validate, diagnose and mimic electro-rheological dampers.

    import erdctl

    log = erdctl.read("lab.csv", map={"t": "Time[ms]", "x": "Defl FL[mm]", "force": "F_fl[N]"})
    erdctl.inspect(log)                          # what the log holds, and what it can show
    damper = erdctl.identify(log)                # the paper's parameters, with standard errors
    erdctl.validate(damper, "other.parquet")     # NRMSE per PWM level
    erdctl.simulate(damper, "drive.csv", faults=["oil=0.5@15:31"])
    found = erdctl.diagnose(log)                 # where the model fails, what was left out
    erdctl.mimic(found, "drive.csv", ["oil=0.5@15:31"]).write("pwm.mat")
    erdctl.effects("input_delay")                # the catalogue that diagnose searches

Units are SI: s, m, m/s, N, V, degC; duty is a fraction from 0 to 1. x is positive in compression.

A log is what `read` gave; every function also takes a path, a pandas DataFrame with the columns t,
x, xdot, duty, force, record (only t and x are needed everywhere), or a list of them. Parameters are
what `identify` or `diagnose` gave (of which the corrected ones are taken), the path of a parameter
file, or its dict. Options are those of the command of the same name.

A result has
    .table()      a pandas frame, one row an item, with units in a column or in the columns' names
    .plot(kind)   a matplotlib Figure; the kinds are those of `erdctl plot --help`
    .to_dict()    the JSON document of the command, with the same schema and the same numbers
    .write(path)  the file that the command writes: `damper.write("damper.json")` and then
                  `erdctl validate damper.json other.csv` in a shell
    .remarks      what was assumed, converted or could not be told; nothing is printed
and shows itself in a notebook. The catalogue has no picture and no remarks; of `simulate`, which
writes a table, `.to_dict()` gives the columns.

What goes wrong for a reason of the data or of the call is an `erdctl.ErdctlError` whose one line
says what to do: `InputProblem`, `UsageProblem` or `ComputationProblem` of `erdctl.core.errors`.

Nothing heavy is loaded before the first call. The packages `erdctl.diagnose`, `erdctl.effects` and
`erdctl.mimic` bear the names of functions: as attributes these names are the functions, and the
modules are had by `from erdctl.diagnose.diagnosis import Verdict`.
"""

from __future__ import annotations

import sys
from types import ModuleType
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from erdctl.core.errors import ErdctlError
    from erdctl.core.version import __version__
    from erdctl.interface.diagnose import diagnose
    from erdctl.interface.effects import effects
    from erdctl.interface.identify import identify
    from erdctl.interface.inspect import inspect
    from erdctl.interface.log import read
    from erdctl.interface.mimic import mimic
    from erdctl.interface.simulate import simulate
    from erdctl.interface.validate import validate

__all__ = [
    "ErdctlError", "__version__", "diagnose", "effects", "identify", "inspect", "mimic", "read",
    "simulate", "validate",
]  # fmt: skip

_HOMES = {
    "ErdctlError": "erdctl.core.errors",
    "__version__": "erdctl.core.version",
    "read": "erdctl.interface.log",
}


class _Face(ModuleType):
    """The package as an object: its functions are loaded when they are first asked for."""

    def __getattr__(self, name: str) -> Any:
        if name not in __all__:
            raise AttributeError(f"module 'erdctl' has no attribute '{name}'")
        from importlib import import_module

        home = import_module(_HOMES.get(name, f"erdctl.interface.{name}"))
        found = getattr(home, name)
        self.__dict__[name] = found
        return found

    def __setattr__(self, name: str, value: Any) -> None:
        # The import system binds a room to its name in the package, and would hide the function.
        if not (name in __all__ and isinstance(value, ModuleType)):
            super().__setattr__(name, value)

    def __dir__(self) -> list[str]:
        return sorted({*self.__dict__, *__all__})


sys.modules[__name__].__class__ = _Face
