"""Which trials a run takes, in which order; each by its number alone."""

from __future__ import annotations

import fnmatch
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

from railpatch.evidence.stress.elastic_trials import steady_trials
from railpatch.evidence.stress.inelastic_trials import inelastic_trials
from railpatch.evidence.stress.liquids import COUNT as WET
from railpatch.evidence.stress.liquids import QUICK_COUNT as QUICK_WET
from railpatch.evidence.stress.liquids import wet_mixture
from railpatch.evidence.stress.mixtures import COUNT, QUICK_COUNT, mixture
from railpatch.evidence.stress.trial import Trial
from railpatch.evidence.stress.wheel_trials import wheel_trials

SEED = 20250117
LARGE = 30  # trials of a family, of which a quick run takes a part


@dataclass(frozen=True)
class Plan:
    """seed: of the mixtures. quick: fewer of everything. only: pattern of names as in a shell,
    matched with "family: name, method"; None for all."""

    seed: int = SEED
    quick: bool = False
    only: str | None = None

    @cached_property
    def listed(self) -> list[Trial]:
        """All trials but the mixtures."""
        parts = (steady_trials, wheel_trials, inelastic_trials)
        trials = [trial for part in parts for trial in part(self.quick)]
        if self.quick:
            trials = thinned(trials)
        return [trial for trial in trials if self.takes(trial)]

    @cached_property
    def wet(self) -> list[int]:
        """Numbers of the wet mixtures."""
        numbers = range(QUICK_WET if self.quick else WET)
        if self.only is None:
            return list(numbers)
        return [number for number in numbers if self.takes(wet_mixture(self.seed, number))]

    @cached_property
    def mixtures(self) -> list[int]:
        """Numbers of the mixtures."""
        numbers = range(QUICK_COUNT if self.quick else COUNT)
        if self.only is None:
            return list(numbers)
        return [number for number in numbers if self.takes(mixture(self.seed, number))]

    def takes(self, trial: Trial) -> bool:
        """Whether the pattern takes a trial."""
        if self.only is None:
            return True
        text = f"{trial.family}: {trial.name}, {trial.method}"
        return fnmatch.fnmatchcase(text.lower(), f"*{self.only.lower()}*")

    def __len__(self) -> int:
        return len(self.listed) + len(self.mixtures) + len(self.wet)

    def __getitem__(self, index: int) -> Trial:
        if index < len(self.listed):
            return self.listed[index]
        index -= len(self.listed)
        if index < len(self.mixtures):
            return mixture(self.seed, self.mixtures[index])
        return wet_mixture(self.seed, self.wet[index - len(self.mixtures)])

    def __iter__(self) -> Iterator[Trial]:
        return (self[index] for index in range(len(self)))


def thinned(trials: list[Trial]) -> list[Trial]:
    """Every third of the large families."""
    sizes = Counter(trial.family for trial in trials)
    seen: Counter[str] = Counter()
    kept = []
    for trial in trials:
        if sizes[trial.family] <= LARGE or seen[trial.family] % 3 == 0:
            kept.append(trial)
        seen[trial.family] += 1
    return kept
