"""Which of two effects that do as well in the same place has the name."""

from __future__ import annotations

from erdctl.diagnose.carry_over import carries_over_as_well
from erdctl.diagnose.comparison import compare
from erdctl.diagnose.forward_step import Exploration
from erdctl.diagnose.hypothesis import Hypothesis
from erdctl.diagnose.look_alikes import is_preferred
from erdctl.model.effect import Effect


def has_the_name(
    x: Exploration, other: tuple[Effect, Hypothesis], best: tuple[Effect, Hypothesis]
) -> bool:
    """Whether an effect that does as well should have the name of another, each with its fit.

    Where nothing tells the two apart one may give way, whichever does better by chance.
    """
    (it, of_it), (effect, of_best) = other, best
    if it.name in effect.gives_way_to:
        return True
    if effect.name in it.gives_way_to and compare(x.problem, of_best, of_it).tied:
        return False
    return is_preferred(x.problem, of_it, of_best) and carries_over_as_well(x, of_it, of_best)
