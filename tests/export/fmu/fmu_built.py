"""FMUs, built by this machine's compiler, and one instance of any version with the same methods."""

from __future__ import annotations

import ctypes
import tempfile
from collections.abc import Mapping
from functools import cache
from pathlib import Path

import numpy as np
from fmpy import extract, read_model_description
from fmpy.fmi2 import FMU2Slave
from fmpy.fmi3 import FMU3Slave
from places import FIXTURES

from erdctl.core.recording import Array
from erdctl.export.c.source import write_c
from erdctl.export.fmu.block import FmuBlock
from erdctl.export.fmu.compile import host_compiled
from erdctl.export.fmu.damper import damper_block
from erdctl.export.fmu.package import packaged
from erdctl.export.fmu.version import VERSIONS
from erdctl.io.parameters import read_parameters
from erdctl.model.parameters import Parameters

NUMBERS = tuple(VERSIONS)  # "2", "3"


def table_2() -> Parameters:
    return read_parameters(str(FIXTURES / "table_2.json"))


@cache
def folder() -> Path:
    import atexit
    import shutil

    made = tempfile.mkdtemp(prefix="erdctl_fmu_")
    atexit.register(shutil.rmtree, made, ignore_errors=True)
    return Path(made)


def built(block: FmuBlock, number: str) -> Path:
    """The file of its FMU, with a binary for this machine alone."""
    out = folder() / f"{block.prefix}_{number}.fmu"
    out.write_bytes(packaged(block, version=VERSIONS[number], build=host_compiled).data)
    return out


@cache
def damper(number: str) -> Path:
    p = table_2()
    return built(damper_block(write_c(p, prefix="damper"), p), number)


@cache
def unzipped(path: Path) -> str:
    """Its folder; one for all instances, so that they share one library."""
    return str(extract(str(path), unzipdir=str(path.with_suffix(""))))


class Instance:
    """An instance of an FMU of either version: set, step, get, by names."""

    def __init__(self, path: Path) -> None:
        self.description = read_model_description(str(path))
        self.three = self.description.fmiVersion.startswith("3")
        self.at = {v.name: v.valueReference for v in self.description.modelVariables}
        self.kind = {v.name: v.type for v in self.description.modelVariables}
        self.slave = (FMU3Slave if self.three else FMU2Slave)(
            guid=self.description.guid or self.description.instantiationToken,
            unzipDirectory=unzipped(path),
            modelIdentifier=self.description.coSimulation.modelIdentifier,
            instanceName="one",
        )
        self.slave.instantiate()
        self.t = 0.0

    def start(self, t: float = 0.0, **values: float) -> Instance:
        """Initialise; values are set in Initialization Mode."""
        self.t = t
        if self.three:
            self.slave.enterInitializationMode(startTime=t)
        else:
            self.slave.setupExperiment(startTime=t)
            self.slave.enterInitializationMode()
        self.set(**values)
        self.slave.exitInitializationMode()
        return self

    def set(self, **values: float) -> None:
        for name, value in values.items():
            self.give(name, value)

    def give(self, name: str, value: float) -> None:
        setter = {
            "Real": "setReal", "Float64": "setFloat64", "Integer": "setInteger",
            "Int32": "setInt32", "Boolean": "setBoolean",
        }[self.kind[name]]  # fmt: skip
        getattr(self.slave, setter)([self.at[name]], [value])

    def get(self, name: str) -> float:
        getter = {
            "Real": "getReal", "Float64": "getFloat64", "Integer": "getInteger",
            "Int32": "getInt32", "Boolean": "getBoolean",
        }[self.kind[name]]  # fmt: skip
        return getattr(self.slave, getter)([self.at[name]])[0]

    def step(self, h: float, **values: float) -> float:
        """Set, step, and the first output."""
        self.set(**values)
        self.slave.doStep(self.t, h)
        self.t += h
        return self.get(self.output)

    @property
    def output(self) -> str:
        return next(v.name for v in self.description.modelVariables if v.causality == "output")

    def saved(self) -> bytes:
        state = self.slave.getFMUState() if self.three else self.slave.getFMUstate()
        kept = (
            self.slave.serializeFMUState(state)
            if self.three
            else self.slave.serializeFMUstate(state)
        )
        (self.slave.freeFMUState if self.three else self.slave.freeFMUstate)(state)
        return bytes(kept)

    def restore(self, kept: bytes) -> None:
        if self.three:
            state = self.slave.deserializeFMUState(kept)
            self.slave.setFMUState(state)
            self.slave.freeFMUState(state)
        else:
            state = self.slave.deSerializeFMUstate(kept)
            self.slave.setFMUstate(state)
            self.slave.freeFMUstate(state)

    def close(self) -> None:
        self.slave.terminate()
        self.slave.freeInstance()


def driven(instance: Instance, signals: Mapping[str, Array], t: Array, **initial: float) -> Array:
    """The first output at all samples: the inputs of each are set for the step that ends there.

    initial : how it begins

    The functions of FMI are called directly, as FMPy's own for lists take ten times as long.
    """
    slave, n = instance.slave, len(signals)
    out = instance.output
    real = ctypes.c_double
    where = (ctypes.c_uint * n)(*(instance.at[name] for name in signals))
    asked, one, values = (ctypes.c_uint * 1)(instance.at[out]), (real * 1)(), (real * n)()
    view = np.frombuffer(values)
    rows = np.column_stack([*signals.values()])
    instance.start(t[0], **{name: float(v[0]) for name, v in signals.items()}, **initial)
    force = np.empty(len(t))
    force[0] = instance.get(out)
    for i in range(1, len(t)):
        view[:] = rows[i]
        if instance.three:
            slave.fmi3SetFloat64(slave.component, where, n, values, n)
            slave.doStep(t[i - 1], t[i] - t[i - 1])
            slave.fmi3GetFloat64(slave.component, asked, 1, one, 1)
        else:
            slave.fmi2SetReal(slave.component, where, n, values)
            slave.doStep(t[i - 1], t[i] - t[i - 1])
            slave.fmi2GetReal(slave.component, asked, 1, one)
        force[i] = one[0]
    return force
