"""The same samples twice in a log: a file that was copied, or cuts that overlap."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from erdctl.bench.rig.fault import RigFault
from erdctl.bench.rig.pieces import Piece, resolution
from erdctl.core.quantiles import median
from erdctl.core.recording import Array, Index

WINDOW = 32  # samples that are compared at once
ONE_OF = 32  # samples begins a window
LEAST = 4 * WINDOW  # samples that are the same
NOISY, WHITE = 0.5, 1.2  # of the resolution; see `white_noise`
WHOLE = 0.95  # of a record
FACTOR = np.uint64(0x9E3779B97F4A7C15)  # any that is odd and has bits all over


@dataclass(frozen=True, eq=False)
class _Same:
    """Samples of a piece that are those of an earlier one.

    first_earlier, first_later : the first of them in either;  length : how many
    """

    earlier: Piece
    later: Piece
    first_earlier: int
    first_later: int
    length: int

    @property
    def whole(self) -> bool:
        """Whether they are all of two records, but a few at the ends."""
        longest = max(len(self.earlier), len(self.later))
        return self.earlier.record != self.later.record and self.length > WHOLE * longest

    def of(self, channel: str) -> tuple[Array, Array]:
        """(length,) a channel in the earlier one and in the later one."""
        a, b, n = self.first_earlier, self.first_later, self.length
        return self.earlier.of(channel)[a : a + n], self.later.of(channel)[b : b + n]

    def copy(self) -> list[RigFault]:
        """The later record is left out; both are where motion or duty is not the same as well, as
        nobody knows of which of them the force is.
        """
        a, b = self.earlier, self.later
        other = next((c for c in ("duty", "x") if not np.array_equal(*self.of(c))), None)
        if other is None:
            return [
                RigFault(
                    "record_twice", b.record,
                    f"its force is that of record '{a.name}', sample for sample",
                    "it is left out of fits, which would count it twice; look at which file was"
                    " copied", blocks=True,
                )
            ]  # fmt: skip
        levels = [100.0 * median(duty) for duty in self.of("duty")]
        out = []
        for own, beside, (here, there) in ((a, b, levels), (b, a, levels[::-1])):
            what = f"duty is not ({here:.3g} for {there:.3g} % in the median)"
            out.append(
                RigFault(
                    "record_twice", own.record,
                    f"its force is that of record '{beside.name}', sample for sample, and its"
                    f" {what if other == 'duty' else 'motion is not'}",
                    "both are left out of fits; look at which file was copied, and whose it was",
                    blocks=True,
                )
            )  # fmt: skip
        return out

    def overlap(self) -> RigFault:
        """The samples of the later one are left out."""
        a, b = self.earlier, self.later
        where = "in the same record" if a.record == b.record else f"in record '{a.name}'"
        before, t = self.of("t")
        first = b.first + self.first_later
        return RigFault(
            "record_twice", b.record,
            f"its force from {t[0]:.5g} to {t[-1]:.5g} s is that from {before[0]:.5g} s on {where},"
            " sample for sample",
            "fits take it once; look at how the log was cut, or put together",
            samples=np.arange(first, first + self.length),
        )  # fmt: skip


def check(found: Sequence[Piece]) -> list[RigFault]:
    """Records that hold the force of another one, sample for sample.

    Noise is never the same twice. A force without any may be, as one that was simulated: of one
    duty and another below the threshold of a field, or from cycle to cycle. Of such records only
    those are told whose motion and duty are the same ones as well.
    """
    out: list[RigFault] = []
    lost: set[int | None] = set()
    for same in [*_copies(found), *_same([p for p in found if _noisy(p)])]:
        faults = same.copy() if same.whole else [same.overlap()]
        out += [f for f in faults if f.record not in lost]
        lost |= {f.record for f in faults if f.blocks}
    return out


def _copies(pieces: Sequence[Piece]) -> Iterator[_Same]:
    """Pieces of which motion, duty and force are those of an earlier one."""
    first: dict[bytes, Piece] = {}
    for p in pieces:
        earlier = first.setdefault(p.force[::ONE_OF].tobytes(), p)
        if (
            earlier is not p
            and np.ptp(p.force) > 0.0
            and all(
                np.array_equal(earlier.of(channel), p.of(channel))
                for channel in ("force", "x", "duty")
            )
        ):
            yield _Same(earlier, p, 0, 0, len(p))


def _noisy(p: Piece) -> bool:
    noise, white = p.noise("force")
    return noise > NOISY * resolution(p.force) and white > WHITE


def _same(pieces: Sequence[Piece]) -> Iterator[_Same]:
    """What is in two of the pieces, by the later one, the longest of it first."""
    kept = [_windows(p.force) for p in pieces]
    if not kept:
        return
    sums, at = (np.concatenate(c) for c in zip(*kept, strict=True))
    own = np.repeat(np.arange(len(kept)), [len(k[0]) for k in kept])
    order = np.argsort(sums, kind="stable")  # np.unique would import masked arrays
    new = np.diff(sums[order], prepend=~sums[order[:1]]) != 0
    firsts = order[np.maximum.accumulate(np.where(new, np.arange(len(order)), 0))]
    again, once = order[~new], firsts[~new]
    found = np.stack([own[once], own[again], at[again] - at[once]], axis=1)
    shifts = Counter(tuple(row) for row in found.tolist())
    for (i, j, shift), _ in sorted(shifts.items(), key=lambda s: (s[0][1], -s[1])):
        begin, length = _shared(pieces[i].force, pieces[j].force, shift)
        if length >= LEAST:
            yield _Same(pieces[i], pieces[j], begin - shift, begin, length)


def _windows(force: Array) -> tuple[npt.NDArray[np.uint64], Index]:
    """Sums (k,) over windows of a force (n,), each sample with a weight of its own, and their first
    samples. Which ones begin a window their value tells, so that the same ones do in a copy.
    """
    bits = np.ascontiguousarray(force, dtype=np.float64).view(np.uint64)
    begins = (bits ^ (bits >> np.uint64(29))) * FACTOR < np.uint64(2**64 // ONE_OF)
    at = np.flatnonzero(begins[: 1 - WINDOW])
    # Where the force stands, as at a limit, windows are the same ones and tell nothing.
    at = at[(force[at] != force[at + 1]) | (force[at] != force[at + WINDOW // 2])]
    within = np.arange(WINDOW)
    weights = np.cumprod(np.full(WINDOW, FACTOR))  # modulo 2^64
    return (bits[at[:, None] + within] * weights).sum(axis=1, dtype=np.uint64), at


def _shared(a: Array, b: Array, shift: int) -> tuple[int, int]:
    """First sample in b, and length, of the longest run of b that is a moved by so many samples."""
    low, high = max(0, shift), min(len(b), len(a) + shift)
    same = a[low - shift : high - shift] == b[low:high]
    ends = np.flatnonzero(np.concatenate([[True], ~same, [True]]))
    longest = int(np.argmax(np.diff(ends)))
    return low + int(ends[longest]), int(ends[longest + 1] - ends[longest] - 1)
