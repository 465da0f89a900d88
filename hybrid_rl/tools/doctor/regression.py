"""Regressions of the checks, judged by decisions that they were not fitted to.

    y = W phi(z),  phi(z) = (1, z, z z^T),  W = argmin |Y - W Phi|^2 + ridge |W|^2,

with z scaled to variance 1 and cut off at FAR; phi is linear where z has too many entries for the
decisions there are. Each of two folds, stretches of time in turn, is predicted by W of the other.
"""

from typing import Any

import numpy as np

from hybrid_rl.tools.doctor.limits import ERRORS, HISTORY, LEAST

FAR = 4.0  # standard deviations
FOLDS = 100  # stretches of time, of which every second one is predicted by the others
PER_FEATURE = 10  # decisions at least for each feature of a regression
RIDGE = 1e-4  # of features with variance 1, per decision


def residual(z: np.ndarray, y: np.ndarray) -> np.ndarray:
    """[N, q] of y [N, q] predicted from z [N, p], each by decisions of other times."""
    return y - sum(predicted([features(z)], y))


def explained(z: np.ndarray, y: np.ndarray) -> np.ndarray:
    """[q] share of the variance of y [N, q] that z [N, p] predicts; 0 if its mean does better."""
    left = (residual(z, y) ** 2).mean(0) / np.maximum(y.var(0), np.finfo(float).tiny)
    return np.maximum(1 - left, 0)


def predicted(blocks: list[Any], y: Any, fold: np.ndarray | None = None) -> list[np.ndarray]:
    """The part [N, q] of each block [N, p] of features in the prediction of y [N, q].

    fold: [N] 0 or 1.
    """
    fold = np.arange(len(y)) * FOLDS // len(y) % 2 if fold is None else fold
    phi, each = np.concatenate(blocks, axis=1), [np.empty_like(y, float) for _ in blocks]
    cuts = np.cumsum([block.shape[1] for block in blocks])[:-1]
    for part in (0, 1):
        own, other = fold == part, fold != part
        a, b = phi[other], y[other].astype(float)
        weights = np.linalg.solve(a.T @ a + RIDGE * len(a) * np.eye(a.shape[1]), a.T @ b)
        for one, p, w in zip(
            each, np.split(phi[own], cuts, 1), np.split(weights, cuts), strict=True
        ):
            one[own] = p @ w
    return each


def missed(y: Any, prediction: Any) -> np.ndarray:
    """[N, q] squared error of y over its variance, in no decision more than that."""
    return np.minimum((y - prediction) ** 2 / np.maximum(y.var(0), np.finfo(float).tiny), 1.0)


def halved(new: np.ndarray, old: np.ndarray) -> np.ndarray:
    """[q] whether errors `old` [N, q] exceed LEAST, and `new` are surely below HISTORY of them."""
    less = old - new
    sure = less.mean(0) > ERRORS * less.std(0) / np.sqrt(len(less))
    return sure & (new.mean(0) < HISTORY * old.mean(0)) & (old.mean(0) > LEAST)


def features(z: np.ndarray) -> np.ndarray:
    """phi [N, P] of z [N, p]."""
    z = scaled(z)
    phi = [np.ones((len(z), 1)), z]
    if curved(z):
        i, j = np.triu_indices(z.shape[1])
        phi.append(z[:, i] * z[:, j])
    return np.concatenate(phi, axis=1)


def products(action: np.ndarray, obs: np.ndarray) -> np.ndarray:
    """[N, m(1+p)] action [N, m] and its products with obs [N, p]."""
    return np.concatenate([action, *(action * entry[:, None] for entry in scaled(obs).T)], axis=1)


def scaled(z: np.ndarray) -> np.ndarray:
    """[N, p] with mean 0 and variance 1, cut off."""
    z = np.asarray(z, float)
    return np.clip((z - z.mean(0)) / np.maximum(z.std(0), np.finfo(np.float32).eps), -FAR, FAR)


def curved(z: np.ndarray) -> bool:
    """Whether z [N, p] are decisions enough for the products of its entries."""
    n, p = z.shape
    return n >= PER_FEATURE * (1 + p + p * (p + 1) // 2)
