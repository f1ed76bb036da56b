"""A problem with fewer samples, among whose hypotheses is searched.

What an effect does to the force it does mostly after the motion turns or the control steps, within
tens of milliseconds: a spring stretches, a play runs out, the yield force rises. Every k-th sample
of a long log would leave none there, and one effect would look like another. So such stretches are
kept at the full rate, if there are many a part of them, and between them every k-th sample, as far
apart as the motion allows. A motion that is fast all along, as where a wheel hops, allows hardly
any: of such records whole stretches are followed, each with the time before it in which a damper
forgets, and of the rest a few samples. Time runs on: states with a long memory go through it all.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import numpy.typing as npt

from erdctl.core.blocks import Block
from erdctl.core.recording import Array, Index
from erdctl.core.signals import Signals
from erdctl.diagnose import thresholds
from erdctl.diagnose.problem import Problem

Mask = npt.NDArray[np.bool_]


def thinned(problem: Problem, most: int) -> Problem:
    """The problem with about `most` of its samples, up to four times as many of a fast motion.

    Samples in a stretch after a turn or a step that is not kept whole stay without weight, and so
    does what lies between stretches of a fast motion.
    """
    s = problem.block.signals
    if len(s) <= most:
        return problem
    record = np.repeat(np.arange(len(s.starts) - 1), np.diff(s.starts))
    row = np.arange(len(s)) - s.starts[record]
    apart = -(-len(s) // (most // 2))
    every = np.array([min(apart, _apart(s, r)) for r in range(len(s.starts) - 1)])[record]
    even = row % every == 0
    fine = max(1, int(thresholds.FINE_STEP / s.typical_step))
    at = _at_duty_steps(s, record)
    at[_turns(problem, record)] = True  # a channel that averages has each of them for long

    def dense(most: int) -> tuple[Mask, Mask]:
        """What is taken where so many samples may be next to turns and steps, and what is left."""
        whole, left = _stretches(problem, record, most)
        left &= every > fine  # a motion that is fast is as dense everywhere
        return even | (whole & (row % fine == 0)) | at, left

    taken, left = dense(most // 2)
    if np.count_nonzero(taken) > thresholds.TOO_MANY * most:
        taken, _ = dense(2 * len(s))  # all turns, and all steps
        share = _share(np.bincount(record, taken), round(thresholds.IN_STRETCHES * most))
        followed, beside = _followed(problem, record, share)
        coarse = _even(len(s) // apart, len(s), np.random.default_rng(0)) | (row == 0)
        taken = (taken & (followed | beside)) | coarse
        left = ~followed
    rows = np.flatnonzero(taken)
    starts = np.searchsorted(rows, s.starts)
    weight = np.where(left, 0.0, problem.block.weight)[rows]
    recording = problem.recording.take(rows, starts, problem.recording.names)
    return replace(
        problem,
        recording=recording,
        block=Block(s.at(rows, recording), problem.block.force[rows], weight),
        group=_numbered(problem.group[rows]),
        stretch=_numbered(problem.stretch[rows]),
        unsure=problem.unsure[rows],
    )


def _stretches(problem: Problem, record: Index, most: int) -> tuple[Mask, Mask]:
    """(n,) what lies in a stretch that is kept, of about `most` samples in all, and in another."""
    s, rng = problem.block.signals, np.random.default_rng(0)
    turns = _turns(problem, record)
    steps = np.flatnonzero(_stepped(s, record)) + 1
    events = [turns, np.stack([steps - 1, steps])]
    step = s.typical_step
    before, after = (int(np.ceil(t / step)) for t in (thresholds.BEFORE, thresholds.AFTER))
    fine = max(1, int(thresholds.FINE_STEP / step))

    def marked(e: Index) -> Mask:
        return _marked(s, record, e[0] - before, e[1] + after, e[0])

    size = sum(np.count_nonzero(marked(e)) for e in events) / fine
    share = min(1.0, most / max(size, 1.0))
    whole, left = np.zeros((2, len(s)), dtype=np.bool_)
    for e in events:
        run = _runs(e[0], before + after, max(1, round(thresholds.RUN / step)))
        runs = int(run[-1]) + 1 if len(run) else 0
        count = int(np.ceil(share * runs))
        kept = _even(count, runs, rng)[run] | (share == 1.0)
        whole |= marked(e[:, kept])
        left |= marked(e[:, ~kept])
    return whole, left


def _followed(problem: Problem, record: Index, share: Array) -> tuple[Mask, Mask]:
    """(n,) what lies in a stretch that is followed, a share (r,) of each record, and next to one.

    What acts there may have begun before, and a channel that averages goes beyond.
    Some of each group that has weight: without it could not be left out.
    """
    s, rng = problem.block.signals, np.random.default_rng(0)
    first = np.flatnonzero(np.diff(problem.stretch, prepend=-1))
    told = np.bincount(problem.stretch, problem.block.weight) > 0.0
    kept = np.zeros(len(first), dtype=np.bool_)
    for group in range(problem.count):
        own = np.flatnonzero(told & (problem.group[first] == group))
        if len(own):
            count = max(1, round(float(share[record[first[own]]].sum())))
            kept[own[_even(count, len(own), rng)]] = True
    begun, ended = first[kept], np.append(first[1:], len(s))[kept] - 1
    lead, on = (int(np.ceil(t / s.typical_step)) for t in (thresholds.FORGOTTEN, thresholds.AFTER))
    return kept[problem.stretch], _marked(s, record, begun - lead, ended + on, begun)


def _share(counts: Index, most: int) -> Array:
    """(r,) part of each record of some samples (r,) that makes `most` in all: as many of each, or
    all where there are fewer.

    Check: of 8, 2 and 20 samples 14 are 0.75, 1.0 and 0.3 of them: 6, 2 and 6.
    >>> _share(np.array([8, 2, 20]), 14).tolist()
    [0.75, 1.0, 0.3]
    """
    fewest = np.sort(counts)
    left = most - np.concatenate([[0.0], np.cumsum(fewest[:-1])])
    each = left / np.arange(len(counts), 0, -1)  # if all before have what they have
    cut = each[np.argmax(fewest >= each)]
    return np.asarray(np.minimum(1.0, cut / np.maximum(counts, 1.0)))


def _even(count: int, of: int, rng: np.random.Generator) -> Mask:
    """(of,) one of each of so many equal groups: even cover, but in step with no periodic test."""
    kept = np.zeros(of, dtype=np.bool_)
    kept[((np.arange(count) + rng.random(count)) * of / max(count, 1)).astype(int)] = True
    return kept


def _runs(at: Index, reach: int, most: int) -> Index:
    """(k,) number of the run of each of some samples (k,), in order: within reach of the next, and
    all within so many.

    What is kept whole of one must not lie in what is left of the next, as where a wheel hops.
    """
    begins = np.ones(len(at), dtype=np.bool_)
    begins[1:] = np.diff(at) > reach
    part = (at - np.maximum.accumulate(np.where(begins, at, 0))) // most
    begins[1:] |= part[1:] != part[:-1]
    return np.cumsum(begins) - 1


def _turns(problem: Problem, record: Index) -> Index:
    """(2, k) the last sure sample before each turn of the motion, and the first one after it."""
    s = problem.block.signals
    sure = np.flatnonzero(~problem.unsure)
    before, after = sure[:-1], sure[1:]
    turned = (s.compressing[after] != s.compressing[before]) & (record[after] == record[before])
    return np.stack([before[turned], after[turned]])


def _marked(s: Signals, record: Index, first: Index, last: Index, of: Index) -> Mask:
    """(n,) samples between some, the last one included, within the record of others."""
    change = np.zeros(len(s) + 1)
    np.add.at(change, np.maximum(first, s.starts[record[of]]), 1.0)
    np.add.at(change, np.minimum(last + 1, s.starts[record[of] + 1]), -1.0)
    return np.asarray(np.cumsum(change[:-1]) > 0)


def _stepped(s: Signals, record: Index) -> Mask:
    """(n - 1,) whether the duty steps after a sample; never if it changes all the time."""
    stepped = (np.diff(s.duty) != 0) & (record[1:] == record[:-1])
    often = np.count_nonzero(stepped) > thresholds.STEPS_PART * len(s)
    return np.zeros_like(stepped) if often else stepped


def _at_duty_steps(s: Signals, record: Index) -> Mask:
    """(n,) the samples on both sides of a step: the duty is held, so that it stays where it was."""
    stepped = _stepped(s, record)
    out = np.zeros(len(s), dtype=np.bool_)
    out[:-1] |= stepped
    out[1:] |= stepped
    return out


def _apart(s: Signals, record: int) -> int:
    """How many samples of a record lie between those that still follow its motion."""
    xdot: Array = s.xdot[s.starts[record] : s.starts[record + 1]]
    power = np.cumsum(np.abs(np.fft.rfft(xdot - xdot.mean())) ** 2)
    fastest = int(np.searchsorted(power, thresholds.FOLLOWED * power[-1]))  # cycles in the record
    return max(1, int(len(xdot) / (thresholds.PER_CYCLE * max(fastest, 1))))


def _numbered(label: Index) -> Index:
    """Labels counted from 0 without gaps."""
    return np.unique(label, return_inverse=True)[1].astype(np.intp)
