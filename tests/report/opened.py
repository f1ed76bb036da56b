"""A page in a browser."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any


class Opened:
    """A page in a window of its own, and what went over the wire and the console."""

    def __init__(self, browser: Any, path: Path, **options: Any) -> None:
        self.errors: list[str] = []
        self.requests: list[str] = []
        self.context = browser.new_context(
            **{"viewport": {"width": 1280, "height": 800}, "reduced_motion": "reduce", **options}
        )
        self.page = self.context.new_page()
        self.page.on("console", lambda m: self.errors.append(f"{m.type}: {m.text}"))
        self.page.on("pageerror", lambda e: self.errors.append(str(e)))
        self.page.on("dialog", lambda d: self.errors.append(f"dialog: {d.message}"))
        self.page.on("request", lambda r: self.requests.append(r.url))
        self.page.goto(path.as_uri())
        self.page.wait_for_selector("html[data-ready]", state="attached")

    def figure(self, name: str) -> Any:
        return self.page.locator(f"figure[data-figure='{name}']").first

    def view(self, name: str) -> list[float]:
        return json.loads(self.figure(name).get_attribute("data-view"))

    def drawn(self, name: str) -> int:
        return int(self.figure(name).get_attribute("data-drawn"))

    def colours(self, name: str) -> int:
        """How many different opaque colours the figure's canvas holds."""
        return self.page.evaluate(
            """(name) => {
              const canvas = document.querySelector(`figure[data-figure="${name}"] canvas`);
              const { width, height } = canvas;
              const { data } = canvas.getContext("2d").getImageData(0, 0, width, height);
              const seen = new Set();
              for (let i = 0; i < data.length; i += 4) {
                const [r, g, b] = [data[i], data[i + 1], data[i + 2]];
                if (data[i + 3] > 200) seen.add((r >> 4) * 256 + (g >> 4) * 16 + (b >> 4));
              }
              return seen.size;
            }""",
            name,
        )
