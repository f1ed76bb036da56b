"""What files hold reaches a terminal as characters, and in bounded length."""

from __future__ import annotations

import io
import sys

import pytest
from hypothesis import given
from hypothesis import strategies as st

from erdctl.core.messages import LONGEST, shown, tell


@given(st.text(max_size=300))
def test_nothing_commands_a_terminal(text: str) -> None:
    out = shown(text)
    assert not [c for c in out if ord(c) < 32 or 127 <= ord(c) < 160]
    assert not [c for c in out if c in "\u202a\u202b\u202d\u202e\u2066\u2067\u2028"]


@given(st.integers(1, 20_000), st.integers(60, LONGEST))
def test_a_message_is_bounded_and_keeps_its_ends(length: int, most: int) -> None:
    text = "a" + "b" * length + "z"
    out = shown(text, most)
    assert len(out) <= max(most, 1)
    assert out[0] + out[-1] == "az"


@pytest.mark.parametrize("text", ["Dämpfer 前 µ ± 5 N", "a b", "1\u00a0000 N"])
def test_letters_of_any_script_stay(text: str) -> None:
    assert shown(text) == text


def test_nobody_need_listen(monkeypatch: pytest.MonkeyPatch) -> None:
    class Gone(io.StringIO):
        def write(self, text: str) -> int:
            raise BrokenPipeError

    monkeypatch.setattr(sys, "stderr", Gone())
    tell("a remark")
