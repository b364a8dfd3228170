"""An FMU of kind "wheelset" in a folder of its own, and instances of it through fmpy."""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

from railpatch.pinocchio.element import STATE

WRENCH = tuple(f"{name}[{k}]" for name in ("force", "moment") for k in (1, 2, 3))
Result = TypeVar("Result")


class FmuFailure(RuntimeError):
    """A call that the FMU did not do, with its message. status: fmi2Status."""

    def __init__(self, status: int, text: str) -> None:
        self.status = status
        super().__init__(text)


class UnpackedFmu:
    """description: fmpy's. references: by the variables' names. used: which of STATE are inputs;
    inputs: their references."""

    def __init__(self, path: str | Path) -> None:
        from fmpy import read_model_description

        self.description = read_model_description(str(path))
        self.references = {v.name: v.valueReference for v in self.description.modelVariables}
        names = [f"wheelset.{name}" for name in STATE]
        # round wheels on rails that do not change: no x, no pitch
        self.used = [k for k, name in enumerate(names) if name in self.references]
        self.inputs = [self.references[names[k]] for k in self.used]
        self._path, self._folder = str(path), ""
        self._instances: list[Any] = []
        self._message = ""

    def instance(self, kind: Any, interface: Any) -> Any:
        """One whose messages are kept. Closes all where it cannot be made."""
        from fmpy import extract, fmi2

        callbacks = fmi2.fmi2CallbackFunctions()
        callbacks.logger = fmi2.fmi2CallbackLoggerTYPE(self._hear)
        callbacks.allocateMemory = fmi2.fmi2CallbackAllocateMemoryTYPE(fmi2.calloc)
        callbacks.freeMemory = fmi2.fmi2CallbackFreeMemoryTYPE(fmi2.free)
        try:
            if not self._folder:
                self._folder = tempfile.mkdtemp()
                extract(self._path, self._folder)
            found = kind(
                guid=self.description.guid,
                unzipDirectory=self._folder,
                modelIdentifier=interface.modelIdentifier,
                instanceName="contact",
            )
            found.instantiate(callbacks=callbacks, loggingOn=True)
        except BaseException:
            self.close()
            raise
        self._instances.append(found)
        return found

    def call(self, function: Callable[..., Result], *arguments: Any) -> Result:
        """A function of an instance. Raises FmuFailure."""
        from fmpy.fmi1 import FMICallException

        # what was said of earlier calls is no reason of this one
        self._message = ""
        try:
            return function(*arguments)
        except FMICallException as failure:
            raise FmuFailure(failure.status, self._message or str(failure)) from None

    def close(self) -> None:
        """Frees all instances and removes the folder."""
        while self._instances:
            self._instances.pop().freeInstance()
        if self._folder:
            shutil.rmtree(self._folder, ignore_errors=True)
        self._folder = ""

    def _hear(self, _environment: Any, _name: Any, _status: int, _kind: Any, text: bytes) -> None:
        self._message = text.decode("utf-8", "replace")
