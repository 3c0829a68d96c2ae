"""Functions of the state: formulas as text, and their slopes by dual numbers.

A formula runs on balls, or on `Dual`s of balls: a value with its slope along each entry of the state. Python's own parser reads it; what
is not in spec/formats.md is refused.
"""

import ast

from flint import arb, arb_mat

from balls import column, entries, exact, raised, square, zeros


class Refused(Exception):
    """A formula that the format does not have."""


class Dual:
    """A value, and how fast it changes along each entry of the state."""

    def __init__(self, value, slopes):
        self.value, self.slopes = value, slopes

    def __add__(self, other):
        if not isinstance(other, Dual):
            return Dual(self.value + other, self.slopes)
        return Dual(self.value + other.value, [a + b for a, b in zip(self.slopes, other.slopes)])

    def __mul__(self, other):
        if not isinstance(other, Dual):
            return Dual(self.value * other, [a * other for a in self.slopes])
        return Dual(self.value * other.value, [a * other.value + self.value * b for a, b in zip(self.slopes, other.slopes)])

    def __neg__(self):
        return self * arb(-1)

    def __sub__(self, other):
        return self + -other

    def __truediv__(self, other):
        return self * power(other, -1)

    __radd__, __rmul__ = __add__, __mul__

    def __rsub__(self, other):
        return -self + other

    def __rtruediv__(self, other):
        return power(self, -1) * other


def chain(x, value, slope):
    """A function of one argument, by its value and its slope there."""
    if isinstance(x, Dual):
        outer = slope(x.value)
        return Dual(value(x.value), [outer * inner for inner in x.slopes])
    return value(x)


def power(x, exponent):
    return chain(x, lambda v: raised(v, exponent), lambda v: exponent * raised(v, exponent - 1) if exponent else arb(0))


def sqrt(x):
    return chain(x, arb.sqrt, lambda v: 1 / (2 * v.sqrt()))


def sin(x):
    return chain(x, arb.sin, arb.cos)


def cos(x):
    return chain(x, arb.cos, lambda v: -v.sin())


def exp(x):
    return chain(x, arb.exp, arb.exp)


def hypot(x, y):
    return sqrt(x * x + y * y)


def atan2(y, x):
    """Slopes: (x dy − y dx)/(x² + y²)."""
    if not isinstance(x, Dual) and not isinstance(y, Dual):
        return arb.atan2(y, x)
    shape = x if isinstance(x, Dual) else y
    none = [arb(0)] * len(shape.slopes)
    x, y = (part if isinstance(part, Dual) else Dual(part, none) for part in (x, y))
    distance = square(x.value) + square(y.value)
    slopes = [(x.value * dy - y.value * dx) / distance for dx, dy in zip(x.slopes, y.slopes)]
    return Dual(arb.atan2(y.value, x.value), slopes)


def stumpff(order, x):
    """c_k(t) = Σ (−t)^j/(2j + k)! = ₁F₂(1; (k+1)/2, (k+2)/2; −t/4)/k!, with the slope ½(k c_(k+2) − c_(k+1))."""

    def value(k, t):
        return (-t / 4).hypgeom([arb(1)], [arb(k + 1) / 2, arb(k + 2) / 2]) / arb.fac_ui(k)

    return chain(x, lambda t: value(order, t), lambda t: (order * value(order + 2, t) - value(order + 1, t)) / 2)


def sinc(x):
    """sin x/x = ₀F₁(; 3/2; −x²/4), with the slope −x/3 · ₀F₁(; 5/2; −x²/4): both have a value at zero."""
    return chain(x, lambda v: confluent(v, 3), lambda v: -v / 3 * confluent(v, 5))


def bessel_1(x):
    """j₁(x) = sin x/x² − cos x/x = x/3 · ₀F₁(; 5/2; −x²/4), with the slope ₀F₁(; 5/2)/3 − x²/15 · ₀F₁(; 7/2)."""
    return chain(x, lambda v: v / 3 * confluent(v, 5), lambda v: confluent(v, 5) / 3 - square(v) / 15 * confluent(v, 7))


def confluent(v, halves):
    """₀F₁(; halves/2; −v²/4)."""
    return (-square(v) / 4).hypgeom([], [arb(halves) / 2])


FUNCTIONS = {
    "sqrt": sqrt,
    "exp": exp,
    "ln": lambda x: chain(x, arb.log, lambda v: 1 / v),
    "sin": sin,
    "cos": cos,
    "tan": lambda x: chain(x, arb.tan, lambda v: 1 + square(v.tan())),
    "atan2": atan2,
    "hypot": hypot,
    **{f"c{order}": lambda x, order=order: stumpff(order, x) for order in range(10)},
}

OPERATIONS = {
    ast.Add: lambda a, b: a + b,
    ast.Sub: lambda a, b: a - b,
    ast.Mult: lambda a, b: a * b,
    ast.Div: lambda a, b: a / b,
}


def evaluate(text, names):
    """The value of a formula; `names` is asked for what a name stands for."""
    try:
        return value_of(ast.parse(text.replace("^", "**").strip(), mode="eval").body, names)
    except SyntaxError as error:
        raise Refused(f"`{text}` is no formula: {error}") from None


def value_of(node, names):
    """The value of a node of Python's syntax tree; every number is the double nearest to its decimal."""
    if isinstance(node, ast.Constant) and type(node.value) in (int, float):
        return exact(node.value)
    if isinstance(node, ast.Name):
        return names(node.id)
    if isinstance(node, ast.UnaryOp) and isinstance(node.op, (ast.USub, ast.UAdd)):
        operand = value_of(node.operand, names)
        return -operand if isinstance(node.op, ast.USub) else operand
    if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Pow):
        return power(value_of(node.left, names), whole_number(node.right))
    if isinstance(node, ast.BinOp) and type(node.op) in OPERATIONS:
        return OPERATIONS[type(node.op)](value_of(node.left, names), value_of(node.right, names))
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id in FUNCTIONS:
        return FUNCTIONS[node.func.id](*[value_of(argument, names) for argument in node.args])
    raise Refused(f"column {node.col_offset + 1}: {ast.unparse(node)}")


def whole_number(node):
    """An exponent, which must be written as an integer."""
    sign = 1
    if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub):
        sign, node = -1, node.operand
    if isinstance(node, ast.Constant) and type(node.value) is int:
        return sign * node.value
    raise Refused(f"column {node.col_offset + 1}: an exponent that is no integer")


class Scope:
    """What names stand for: numbers, and definitions that are evaluated when they are asked for."""

    def __init__(self, numbers, definitions):
        self.known = {"pi": arb.pi(), **numbers}
        self.definitions = dict(definitions)

    def __call__(self, name):
        if name not in self.known:
            if name not in self.definitions:
                raise Refused(f"`{name}` is not known")
            self.known[name] = evaluate(self.definitions[name], self)
        return self.known[name]


# --------------------------------------------------------------------------------------------------- functions of the state


class Affine:
    """x ↦ A x + b."""

    def __init__(self, matrix, offset=None):
        self.matrix = matrix
        self.offset = zeros(matrix.nrows(), 1) if offset is None else offset

    def at(self, x):
        return self.matrix * x + self.offset

    def slopes(self, _x):
        return self.matrix


class Curved:
    """x ↦ f(x), given as a Python function of a list of numbers."""

    def __init__(self, function):
        self.function = function

    def at(self, x):
        return column(self.function(entries(x)))

    def slopes(self, x):
        """The Jacobian: row i has the slopes of entry i."""
        size = x.nrows()
        duals = [Dual(entry, [arb(int(i == j)) for j in range(size)]) for i, entry in enumerate(entries(x))]
        return arb_mat([y.slopes if isinstance(y, Dual) else [arb(0)] * size for y in self.function(duals)])

    def as_affine(self, size):
        """The same as a matrix and an offset; refused where the slopes are others at another place."""
        origin, elsewhere = zeros(size, 1), column([arb(3 * i + 2) / 7 for i in range(size)])
        if not self.slopes(origin).overlaps(self.slopes(elsewhere)):
            raise Refused("a function that is not linear, under a filter that needs a matrix")
        return Affine(self.slopes(origin), self.at(origin))


def rows_of(function, rows):
    """The entries of a function that are asked for."""
    if isinstance(function, Affine):
        pick = arb_mat([[int(row == i) for i in range(function.matrix.nrows())] for row in rows])
        return Affine(pick * function.matrix, pick * function.offset)
    return Curved(lambda x: [function.function(x)[row] for row in rows])
