"""The catalogue of effects as JSON."""

from __future__ import annotations

from typing import Any

from erdctl.model.effect import Effect


def facts_of(effect: Effect) -> dict[str, Any]:
    """What an effect declares, but for its functions."""
    return {
        "name": effect.name,
        "title": effect.title,
        "stage": effect.stage.value,
        "equation": effect.equation,
        "source": effect.source,
        "validity": effect.validity,
        "needs": "; ".join(r.value for r in effect.requires),
        "shows": effect.shows.value,
        "equivalent": ", ".join(effect.equivalents),
        "parameters": [
            {
                "symbol": q.symbol,
                "unit": q.unit,
                "title": q.title,
                "low": q.low,
                "high": q.high,
                "off": q.off,
            }
            for q in effect.quantities
        ],
    }
