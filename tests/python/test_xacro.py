# SPDX-License-Identifier: Apache-2.0
"""Expressions of xacro files, by Python itself."""

import math
import random
import re
from xml.sax.saxutils import quoteattr

import penumbra

NAMES = {name: getattr(math, name) for name in dir(math) if not name.startswith("_")}
NAMES.update(
    {f.__name__: f for f in (str, int, float, len, min, max, round, list, dict, abs, sorted, sum)},
    math=math, a=3, b=-0.5, text="left hand", flag=True,
    items=[4, 1.5, "x", [7, 8]], table={"width": 0.2},
)
# The lexer of xacro ends an expression at the first brace.
PROPERTIES = "".join(
    f'<xacro:property name="{name}" value={quoteattr("${" + value + "}")}/>'
    for name, value in {
        "a": "3", "b": "-0.5", "text": "'left hand'", "flag": "True",
        "items": "[4, 1.5, 'x', [7, 8]]", "table": "dict(width=0.2)"}.items()
)


def evaluated(expression):
    """Returns what Penumbra makes of it, as text; None if it is refused."""
    xml = (f'<robot name="r">{PROPERTIES}<link name='
           f'{quoteattr("<${" + expression + "}>")}/></robot>')
    try:
        return penumbra.Robot.parse(xml, ".").links[0]
    except penumbra.InputError:
        return None


def without_signs(text):
    return re.sub(r"-0\.0\b", "0.0", text)


class Maker:
    """Makes random expressions; Python accepts most of them."""

    def __init__(self, seed):
        self.random = random.Random(seed)

    def number(self, depth):
        pick = self.random.randrange(16 if depth > 0 else 5)
        inner = lambda: self.number(depth - 1)
        if pick < 2:
            return self.random.choice(["0", "1", "2", "7", "10", "0.25", "1.", ".5", "1e-3", "2.5E2"])
        if pick < 5:
            return self.random.choice(["a", "b", "pi", "items[0]", "items[-1][1]", "table['width']",
                                       "len(text)", "flag"])
        if pick < 10:
            return f"{inner()} {self.random.choice(['+', '-', '*', '/', '//', '%'])} {inner()}"
        if pick == 10:
            return f"({inner()}) ** {self.random.choice(['2', '3.', '-1'])}"
        if pick == 11:
            return f"-({inner()})"
        if pick == 12:
            name = self.random.choice(["sin", "math.cos", "radians", "float", "int", "abs", "floor",
                                       "round", "degrees", "sqrt", "ceil"])
            return f"{name}({inner()})"
        if pick == 13:
            return f"{self.random.choice(['min', 'max', 'atan2'])}({inner()}, {inner()})"
        if pick == 14:
            return f"({inner()} if {self.truth(depth - 1)} else {inner()})"
        return f"sum([x * 2 for x in [{inner()}, {inner()}] if x > 0])"

    def truth(self, depth):
        pick = self.random.randrange(8 if depth > 0 else 4)
        if pick < 2:
            return f"{self.number(depth)} {self.random.choice(['<', '<=', '==', '!=', '>', '>='])} {self.number(depth)}"
        if pick == 2:
            return self.random.choice(["flag", "'hand' in text", "'x' not in items", "a in [1, 2, 3]"])
        if pick == 3:
            return f"0 < {self.number(0)} <= 10"
        if pick == 4:
            return f"not {self.truth(depth - 1)}"
        return f"({self.truth(depth - 1)} {self.random.choice(['and', 'or'])} {self.truth(depth - 1)})"

    def text(self, depth):
        pick = self.random.randrange(7 if depth > 0 else 3)
        if pick < 3:
            return self.random.choice(["'up'", '"it\'s"', "text", "str(b)", "text[1:4]", "text[-2]",
                                       "'a,b'.split(',')[1]", "text.upper()", "text.strip('lfand ')", "text.rstrip('_hand')", "' a '.lstrip()", "'' 'ab'"])
        if pick < 5:
            return f"{self.text(depth - 1)} + {self.text(depth - 1)}"
        if pick == 5:
            return f"str({self.number(depth - 1)})"
        return f"str([{self.number(depth - 1)}, {self.text(depth - 1)}, None])"

    def any(self):
        return self.random.choice([self.number, self.truth, self.text])(3)


def test_random_expressions_are_those_of_python():
    seed = 20
    print("seed", seed)
    make = Maker(seed)
    agreed = refused = 0
    for _ in range(3000):
        expression = make.any()
        try:
            expected = str(eval(expression, {"__builtins__": {}}, dict(NAMES)))
        except Exception:  # an error of the expression's own
            expected = None
        if expected is not None and len(expected) > 200:
            continue
        got = evaluated(expression)
        if got is None:
            refused += 1
            # Whole numbers beyond 64 bits, complex and not finite ones are refused.
            assert expected is None or "nan" in expected or "j" in expected or "inf" in expected \
                or len(expected) > 17, expression
        else:
            agreed += 1
            assert expected is not None, expression
            # The sign of a zero is not Python's everywhere.
            assert without_signs(got) == without_signs(f"<{expected}>"), expression
    assert agreed > 2000 and refused < 900
