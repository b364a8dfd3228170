"""Samples of the posterior: emcee's ensemble (Foreman-Mackey et al. 2013, PASP 125, 306-312).

Uniform within the ranges, times the priors that are given; the noise is that of the fit.
"""

from __future__ import annotations

from importlib.util import find_spec

import numpy as np
from numpy.typing import NDArray

from railpatch.errors import CaseError
from railpatch.match.fit import Fit, Search
from railpatch.match.found_parts import Sampled
from railpatch.match.plan import MatchTable

# of the walkers' steps, which are left out
BURNT = 0.2
SAMPLER, SCREENER = "emcee", "SALib"


def need_samplers(table: MatchTable) -> None:
    """Raises CaseError where a library that a match asks for is not installed."""
    for asked, module, extra in (
        (table.sampling == SAMPLER, SAMPLER, "sampling"),
        (table.screening, SCREENER, "match"),
    ):
        if asked and find_spec(module) is None:
            raise CaseError(f"{module} is not installed: pip install 'railpatch[{extra}]'")


def sampled(search: Search, fit: Fit) -> dict[str, Sampled]:
    """By key. Raises CaseError."""
    import emcee

    table, count = search.model.plan.table, len(fit.shares)

    def logarithm(shares: NDArray[np.float64]) -> float:
        if not ((shares >= 0) & (shares <= 1)).all():
            return -np.inf
        prior = search.prior(shares)
        likelihood = search.likelihood(search.computed(shares), fit.noise)
        return likelihood - 0.5 * float(prior @ prior)

    random = np.random.default_rng(table.seed)
    walkers = max(2 * count + 2, 8)
    spread = np.sqrt(np.diag(fit.covariance))
    start = fit.shares + spread * random.standard_normal((walkers, count))
    sampler = emcee.EnsembleSampler(walkers, count, logarithm)
    sampler.random_state = np.random.RandomState(table.seed).get_state()
    sampler.run_mcmc(np.clip(start, 1e-3, 1 - 1e-3), table.samples)
    chain = sampler.get_chain(discard=int(BURNT * table.samples), flat=True)
    ends = np.quantile(chain, [0.5, 0.025, 0.975], axis=0)
    return {
        key: Sampled(*(one.at(float(share)) for share in ends[:, k]))
        for k, (key, one) in enumerate(search.model.explanation.seek.items())
    }
