"""Equations as the catalogue writes them, plain text, typeset as MathML.

Browsers draw MathML without a script. No library reads this notation (`F_ER sign(xdot) -> ...`,
with words between the formulas), and it is small: names, numbers, brackets, fractions, powers.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

from markupsafe import Markup, escape

from erdctl.model.corrected_equation import split

NAMESPACE = "http://www.w3.org/1998/Math/MathML"
GREEK = {
    "alpha": "α", "beta": "β", "gamma": "γ", "delta": "δ", "kappa": "κ", "lambda": "λ", "mu": "μ",
    "sigma": "σ", "tau": "τ", "omega": "ω",
}  # fmt: skip
FUNCTIONS = {"sign", "max", "min", "exp", "tanh"}
OPERATORS = {
    "->": "→", "<=": "≤", ">=": "≥", "-": "−", "+": "+", "*": "·", "=": "=", "<": "<", ">": ">",
    ",": ",", ";": ";",
}  # fmt: skip
CLOSING = {"(": ")", "[": "]", "|": "|"}
D = Markup('<mi mathvariant="normal">d</mi>')
DIFFERENTIAL = re.compile(r"d[A-Za-z](?<!do)")
MO = "<mo>", "<mo "  # but not <mover>
TOKEN = re.compile(
    r"\s*(?:"
    r"(?P<derivative>d(?P<order>\d?)(?P<upper>[A-Za-z]\w*?)"
    r"/d(?:(?P<lower>[A-Za-z])\d?(?!\w)|\|(?P<size>[A-Za-z]\w*)\|))"
    r"|(?P<number>\d+(?:\.\d+)?(?:e-?\d+)?(?:\s*(?P<unit>m/s)(?!\w))?)"
    r"|(?P<name>[A-Za-z]\w*)"
    r"|(?P<sign>->|<=|>=|[-+*/^()\[\]|=<>,;])"
    r")"
)
# Of running text: what bears an index, or is no English word, is a symbol.
_LETTERS = "|".join(sorted(GREEK, key=len, reverse=True))
SYMBOL = re.compile(
    rf"(?<![\w/])(?P<head>xdot|{_LETTERS}|[A-Za-z](?=_))(?:_(?P<index>[A-Za-z0-9]+))?(?![\w(])"
    r"|(?<=[\w)|])\^(?P<power>-?\w+)"
)


class _Unreadable(Exception):
    """The text is not in the notation."""


@dataclass(frozen=True)
class _Token:
    kind: str
    text: str
    match: re.Match[str]


def equation(text: str) -> Markup:
    """MathML of an equation, or the text in monospace where it cannot be read.

    Check: equation("g/2") holds an mfrac of g over 2; "v^beta" an msup of v and the letter beta.
    >>> str(equation("g/2")).partition(">")[2]
    '<mfrac><mi>g</mi><mn>2</mn></mfrac></math>'
    >>> str(equation("v^beta")).partition(">")[2]
    '<msup><mi>v</mi><mi>β</mi></msup></math>'
    """
    try:
        parser = _Parser(_tokens(text))
        body = parser.row(None)
    except _Unreadable:
        return Markup('<code class="equation">{}</code>').format(text)
    return Markup('<math xmlns="{}" display="block" alttext="{}">{}</math>').format(
        NAMESPACE, text, body
    )


def flowing(text: str) -> Markup:
    """An equation in pieces between which a line may break: sums at their terms, and clauses.

    A browser breaks no formula, and a long one would be wider than a telephone.
    Check: "F = a + b, b = 1" comes in 3 pieces.
    >>> str(flowing("F = a + b, b = 1")).count("<math")
    3
    """
    pieces = []
    for part in split(text, ";"):
        for clause in split(part, ","):
            first, *more = split(clause.strip(), " + ")
            pieces += [first, *(f"+ {term}" for term in more)]
            pieces[-1] += ","
        pieces[-1] = f"{pieces[-1][:-1]};"
    pieces[-1] = pieces[-1][:-1]
    piece = Markup('<span class="piece">{}</span>')
    typeset = [equation(p) for p in pieces]
    if not all(t.startswith("<math") for t in typeset):
        typeset = [equation(text)]
    inline = [piece.format(_inline(t)) for t in typeset]
    return Markup('<p class="flow">{}</p>').format(Markup(" ").join(inline))


def symbol(name: str) -> Markup:
    """MathML of a parameter's symbol.

    Check: symbol("T_d") is an msub of T and an upright d.
    >>> str(symbol("T_d")).partition(">")[2]
    '<msub><mi>T</mi><mi mathvariant="normal">d</mi></msub></math>'
    """
    return Markup('<math xmlns="{}">{}</math>').format(NAMESPACE, _name(name))


def prose(text: str) -> Markup:
    """A sentence with the symbols in it set as symbols: k_1, xdot, beta, a^2.

    Check: "k_m = 1 / s_m" has an index m twice, and no underscore.
    >>> str(prose("of stiffness k_m"))
    'of stiffness <i>k</i><sub>m</sub>'
    """
    out, at = Markup(), 0
    for match in SYMBOL.finditer(text):
        out += escape(text[at : match.start()])
        at = match.end()
        if match.group("power"):
            out += Markup("<sup>{}</sup>").format(match.group("power").replace("-", "−"))
            continue
        head, index = match.group("head"), match.group("index")
        letter = "ẋ" if head == "xdot" else GREEK.get(head, head)
        out += Markup("<i>{}</i>").format(letter)
        out += Markup("<sub>{}</sub>").format(index) if index else ""
    return out + escape(text[at:])


def _inline(typeset: Markup) -> Markup:
    """A formula for a line of text, as large as one by itself; a sum goes on with its sign."""
    text = str(typeset).replace(' display="block"', ' displaystyle="true"')
    if 'alttext="+ ' in text:
        text = text.replace('<mo form="prefix">+</mo>', '<mo form="infix">+</mo>', 1)
    return Markup(text)


def _tokens(text: str) -> list[_Token]:
    out, at, text = [], 0, text.strip()
    while at < len(text):
        match = TOKEN.match(text, at)
        if match is None or match.lastgroup is None:
            raise _Unreadable(text[at:])
        kind = next(k for k in ("derivative", "number", "name", "sign") if match.group(k))
        out.append(_Token(kind, match.group(kind), match))
        at = match.end()
    return out


class _Parser:
    """Reads tokens from the left; brackets, fractions and powers are all that nests."""

    def __init__(self, tokens: list[_Token]) -> None:
        self.tokens = tokens
        self.at = 0
        self.bars = 0

    def row(self, closing: str | None) -> Markup:
        """Everything up to a closing bracket, or to the end."""
        out: list[Markup] = []
        while self.at < len(self.tokens):
            token = self.tokens[self.at]
            if closing is not None and token.text == closing:
                self.at += 1
                return _row(out)
            if token.kind == "name" and _is_word(token.text):
                out.append(self._words())
            elif token.text in OPERATORS:
                self.at += 1
                prefix = not out or out[-1].startswith(MO)
                out.append(_operator(token.text, prefix=prefix and token.text in "+-"))
            else:
                if out and not out[-1].startswith((*MO, "<mtext", "<mspace")):
                    out.append(Markup('<mspace width="0.17em"></mspace>'))
                out.append(self._quotient())
        if closing is not None:
            raise _Unreadable(f"no {closing}")
        return _row(out)

    def _words(self) -> Markup:
        words = []
        while self.at < len(self.tokens):
            token = self.tokens[self.at]
            if token.kind != "name" or not _is_word(token.text):
                break
            words.append(token.text)
            self.at += 1
        more = self.at < len(self.tokens) and self.tokens[self.at].text not in ",;"
        after = "\u2002" if more else ""
        return Markup("<mtext>\u2002{}{}</mtext>").format(" ".join(words), after)

    def _quotient(self) -> Markup:
        upper, bare_upper = self._power()
        while self.at < len(self.tokens) and self.tokens[self.at].text == "/":
            self.at += 1
            lower, bare_lower = self._power()
            # A fraction's bar does what the brackets did.
            upper = Markup("<mfrac>{}{}</mfrac>").format(bare_upper or upper, bare_lower or lower)
            bare_upper = None
        return upper

    def _power(self) -> tuple[Markup, Markup | None]:
        base, bare = self._primary()
        while self.at < len(self.tokens) and self.tokens[self.at].text == "^":
            self.at += 1
            minus = self.at < len(self.tokens) and self.tokens[self.at].text == "-"
            self.at += minus
            above, bare_above = self._primary()
            above = bare_above or above
            if minus:
                above = _row([_operator("-", prefix=True), above])
            base, bare = Markup("<msup>{}{}</msup>").format(base, above), None
        return base, bare

    def _primary(self) -> tuple[Markup, Markup | None]:
        """One factor; and what is in it, if it is a pair of round brackets."""
        if self.at >= len(self.tokens):
            raise _Unreadable("it ends too early")
        token = self.tokens[self.at]
        self.at += 1
        if token.kind == "number":
            return _number(token), None
        if token.kind == "derivative":
            return _derivative(token.match), None
        if token.kind == "name":
            name = _name(token.text)
            if token.text in FUNCTIONS and self.at < len(self.tokens):
                argument, _ = self._primary()
                return Markup("<mrow>{}<mo>\u2061</mo>{}</mrow>").format(name, argument), None
            return name, None
        if token.text in CLOSING:
            if token.text == "|":
                self.bars += 1
                if self.bars > 1:
                    raise _Unreadable("a bar within bars")
            inside = self.row(CLOSING[token.text])
            self.bars -= token.text == "|"
            return _fenced(token.text, inside), inside if token.text == "(" else None
        raise _Unreadable(token.text)


def _is_word(name: str) -> bool:
    """Whether a name is English rather than a symbol: letters alone, and none of the known."""
    known = name in GREEK or name in FUNCTIONS or re.fullmatch(r"[A-Za-z]|[a-z]+dot", name)
    known = known or DIFFERENTIAL.fullmatch(name)
    return name.isalpha() and not known and name not in {"gas", "viscous", "yield"}


def _row(parts: list[Markup]) -> Markup:
    if len(parts) == 1:
        return parts[0]
    return Markup("<mrow>{}</mrow>").format(Markup("").join(parts))


def _operator(text: str, *, prefix: bool = False) -> Markup:
    if text in ",;":
        return Markup('<mo>{}</mo><mspace width="0.5em"></mspace>').format(text)
    form = "prefix" if prefix else "infix"
    return Markup('<mo form="{}">{}</mo>').format(form, OPERATORS[text])


def _fenced(opening: str, inside: Markup) -> Markup:
    tall = "true" if "<mfrac>" in inside else "false"
    fence = Markup('<mo fence="true" stretchy="{}" form="{}">{}</mo>')
    left = fence.format(tall, "prefix", opening)
    right = fence.format(tall, "postfix", CLOSING[opening])
    return Markup("<mrow>{}{}{}</mrow>").format(left, inside, right)


def _number(token: _Token) -> Markup:
    number = Markup("<mn>{}</mn>").format(token.text.split()[0])
    unit = token.match.group("unit")
    if unit is None:
        return number
    return _row([number, Markup("<mtext>\u2009{}</mtext>").format(unit)])


def _name(text: str) -> Markup:
    """A symbol: Greek letter, dot for a derivative, what follows `_` as upright index."""
    head, _, index = text.partition("_")
    if DIFFERENTIAL.fullmatch(text):
        return _row([D, Markup("<mi>{}</mi>").format(text[1:])])
    if head in FUNCTIONS or head in {"gas", "viscous", "yield"}:
        out = Markup('<mi mathvariant="normal">{}</mi>').format(head)
    elif head.endswith("dot") and len(head) > 3:
        # The combining form would sit next to the letter where no mathematical font is at hand.
        out = Markup('<mover accent="true"><mi>{}</mi><mo>˙</mo></mover>').format(head[:-3])
    else:
        out = Markup("<mi>{}</mi>").format(GREEK.get(head, head))
    if not index:
        return out
    upright = Markup('<msub>{}<mi mathvariant="normal">{}</mi></msub>')
    return upright.format(out, escape(index.replace("_", ",")))


def _derivative(match: re.Match[str]) -> Markup:
    """dF_ER/dt, d2x/dt2, dF_y/d|x|."""
    order, d = match.group("order"), D
    size = match.group("size")
    below = _name(match.group("lower")) if size is None else _fenced("|", _name(size))
    upper = d
    if order:
        power = Markup("<msup>{}<mn>{}</mn></msup>")
        upper, below = power.format(d, order), power.format(below, order)
    return Markup("<mfrac><mrow>{}{}</mrow><mrow>{}{}</mrow></mfrac>").format(
        upper, _name(match.group("upper")), d, below
    )
