"""The contact's side: an FMU of kind "wheelset", stepped by fmpy with all that FMI 2.0 offers."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from railpatch.errors import CaseError
from railpatch.pinocchio.element import STATE

from wheelset_demo.coupling.instance import WRENCH, FmuFailure, Result, UnpackedFmu
from wheelset_demo.system import Vector

DISCARD = 2  # fmi2Discard
MEAN = tuple(f"mean_{name}" for name in WRENCH)
POWERS = ("power", "creep_power")


class Discarded(RuntimeError):
    """A step that could not be done: fmi2Discard, or sides that do not agree. A shorter one may."""


class CouplingFailure(RuntimeError):
    """The run cannot go on."""


@dataclass(frozen=True)
class Outputs:
    """At a communication point. wrench: [6], N, N m. power: W, that the contact gives the wheelset
    by the FMU's own inputs. friction: W, that the creepages and the spin supply."""

    wrench: Vector
    power: float
    friction: float


class ContactSlave:
    """Motions go in, wrenches come out; both as in railpatch.pinocchio."""

    def __init__(self, path: str | Path, substeps: int = 1) -> None:
        """substeps: within a communication step, for means. Raises CaseError for an FMU without
        what masters need."""
        from fmpy.fmi2 import FMU2Slave

        self._fmu = fmu = UnpackedFmu(path)
        wanted = [*WRENCH, *MEAN, *POWERS, "substeps"]
        missing = [name for name in wanted if name not in fmu.references]
        if missing or not fmu.description.coSimulation.providesDirectionalDerivative:
            raise CaseError(
                f"scene: its FMU has no {', '.join(missing) or 'directional derivatives'}, allowed "
                "a scene of wheels without history, packed with averages and derivatives"
            )
        self.used, self._inputs = fmu.used, fmu.inputs
        self._first_order = [1] * len(self.used)
        self._wrench = [fmu.references[name] for name in WRENCH]
        self._mean = [fmu.references[name] for name in MEAN]
        self._outputs = [fmu.references[name] for name in (*WRENCH, *POWERS)]
        self._substeps = [fmu.references["substeps"]]
        self.substeps = substeps
        self._slave: Any = fmu.instance(FMU2Slave, fmu.description.coSimulation)
        self._model: Any = None
        self.steps = 0

    def __enter__(self) -> ContactSlave:
        return self

    def __exit__(self, *_: object) -> None:
        self._fmu.close()

    def _call(self, function: Callable[..., Result], *arguments: Any) -> Result:
        """Raises Discarded and CouplingFailure with the FMU's own message."""
        try:
            return self._fmu.call(function, *arguments)
        except FmuFailure as failure:
            kind = Discarded if failure.status == DISCARD else CouplingFailure
            raise kind(str(failure)) from None

    def begin(self, time: float, motion: Vector) -> None:
        """Starts, or starts anew, at a time (s) and a motion [12]."""
        slave, call = self._slave, self._call
        call(slave.reset)
        call(slave.setInteger, self._substeps, [self.substeps])
        call(slave.setupExperiment, None, time)
        call(slave.enterInitializationMode)
        call(slave.setReal, self._inputs, motion[self.used].tolist())
        call(slave.exitInitializationMode)

    def step(
        self, time: float, step: float, motion: Vector, slope: Vector | None = None
    ) -> Outputs:
        """From a time on, with inputs that are held, or move from there by a slope [12]."""
        slave, call = self._slave, self._call
        call(slave.setReal, self._inputs, motion[self.used].tolist())
        if slope is not None:
            slopes = slope[self.used].tolist()
            call(slave.setRealInputDerivatives, self._inputs, self._first_order, slopes)
        self.steps += 1
        call(slave.doStep, time, step)
        return self.outputs()

    def outputs(self) -> Outputs:
        """At the end of the last step."""
        values = self._call(self._slave.getReal, self._outputs)
        return Outputs(np.array(values[:6]), values[6], values[7])

    def begin_exchange(self, time: float, motion: Vector) -> None:
        """The same for model exchange, by an instance of its own."""
        call = self._call
        if self._model is None:
            from fmpy.fmi2 import FMU2Model

            interface = self._fmu.description.modelExchange
            if interface is None:
                raise CouplingFailure("the FMU has no model exchange: its contact has a history")
            self._model = self._fmu.instance(FMU2Model, interface)
        model = self._model
        call(model.reset)
        call(model.setupExperiment, None, time)
        call(model.enterInitializationMode)
        call(model.setReal, self._inputs, motion[self.used].tolist())
        call(model.exitInitializationMode)
        call(model.newDiscreteStates)
        call(model.enterContinuousTimeMode)

    def evaluate(self, time: float, motion: Vector) -> Outputs:
        """At a time and a motion, by model exchange: no step, no lag."""
        model, call = self._model, self._call
        call(model.setTime, time)
        call(model.setReal, self._inputs, motion[self.used].tolist())
        self.steps += 1
        values = call(model.getReal, self._outputs)
        return Outputs(np.array(values[:6]), values[6], values[7])

    def mean_wrench(self) -> Vector:
        """[6], over the last step."""
        return np.array(self._call(self._slave.getReal, self._mean))

    def wrench_rate(self) -> Vector:
        """[6], N/s, N m/s, at the end of the last step (fmi2GetRealOutputDerivatives)."""
        return np.array(self._call(self._slave.getRealOutputDerivatives, self._wrench, [1] * 6))

    def wrench_by_motion(self) -> Vector:
        """[6, 12], at the end of the last step (fmi2GetDirectionalDerivative)."""
        found = np.zeros((6, len(STATE)))
        derivative = self._slave.getDirectionalDerivative
        for column, reference in zip(self.used, self._inputs, strict=True):
            found[:, column] = self._call(derivative, self._wrench, [reference], [1.0])
        return found

    def save(self) -> Any:
        """To be restored, any number of times, and then released."""
        return self._call(self._slave.getFMUstate)

    def restore(self, state: Any) -> None:
        """The FMU as it was saved."""
        self._call(self._slave.setFMUstate, state)

    def release(self, state: Any) -> None:
        """Frees a saved state."""
        self._call(self._slave.freeFMUstate, state)
