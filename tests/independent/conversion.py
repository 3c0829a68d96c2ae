"""Range and bearing as a position with its covariance, in the forms in which the literature prints them.

With s = σ_θ², the variance of the bearing. `standard`: sustika2015 (20)-(26). `additive`: Lerro and Bar-Shalom 1993. `multiplicative`:
Longbin, Xiaoquan, Yiyu, Kang and Bar-Shalom 1998. `modified-unbiased`: Duan, Han and Li 2004.
"""

from flint import arb_mat

from balls import column


def convert(name, range_, bearing, range_variance, bearing_variance):
    """The position relative to the sensor, and its covariance."""
    return {
        "standard": standard,
        "additive": additive,
        "multiplicative": multiplicative,
        "modified-unbiased": modified_unbiased,
    }[name](range_, bearing, range_variance, bearing_variance)


def place(factor, r, bearing):
    return column([factor * r * bearing.cos(), factor * r * bearing.sin()])


def symmetric(xx, yy, xy):
    return arb_mat([[xx, xy], [xy, yy]])


def standard(r, bearing, v, s):
    """R_xx = r²s sin² + v cos², R_yy = r²s cos² + v sin², R_xy = (v − r²s) sin cos."""
    sine, cosine = bearing.sin(), bearing.cos()
    return place(1, r, bearing), symmetric(
        r**2 * s * sine**2 + v * cosine**2,
        r**2 * s * cosine**2 + v * sine**2,
        (v - r**2 * s) * sine * cosine,
    )


def additive(r, bearing, v, s):
    """The bias r cos θ (e^(−s) − e^(−s/2)) is taken off; the covariance has it and its own error."""
    sine, cosine = bearing.sin(), bearing.cos()
    along = r**2 * ((2 * s).cosh() - s.cosh()) + v * (2 * (2 * s).cosh() - s.cosh())
    across = r**2 * ((2 * s).sinh() - s.sinh()) + v * (2 * (2 * s).sinh() - s.sinh())
    damped = (-2 * s).exp()
    return place(1 - ((-s).exp() - (-s / 2).exp()), r, bearing), symmetric(
        damped * (along * cosine**2 + across * sine**2),
        damped * (along * sine**2 + across * cosine**2),
        sine * cosine * (-4 * s).exp() * (v + (r**2 + v) * (1 - s.exp())),
    )


def multiplicative(r, bearing, v, s):
    """x = r cos θ/λ with λ = e^(−s/2), λ′ = e^(−2s) = λ⁴."""
    shrink = (-s / 2).exp()
    raw = shrink**-2 - 2
    sine, cosine = bearing.sin(), bearing.cos()
    second = (r**2 + v) / 2
    return place(1 / shrink, r, bearing), symmetric(
        raw * r**2 * cosine**2 + second * (1 + shrink**4 * (2 * bearing).cos()),
        raw * r**2 * sine**2 + second * (1 - shrink**4 * (2 * bearing).cos()),
        raw * r**2 * sine * cosine + second * shrink**4 * (2 * bearing).sin(),
    )


def modified_unbiased(r, bearing, v, s):
    """x = λ r cos θ, conditioned on the measurement."""
    shrink = (-s / 2).exp()
    sine, cosine = bearing.sin(), bearing.cos()
    second = (r**2 + v) / 2
    return place(shrink, r, bearing), symmetric(
        second * (1 + (-2 * s).exp() * (2 * bearing).cos()) - (-s).exp() * r**2 * cosine**2,
        second * (1 - (-2 * s).exp() * (2 * bearing).cos()) - (-s).exp() * r**2 * sine**2,
        second * (-2 * s).exp() * (2 * bearing).sin() - (-s).exp() * r**2 * sine * cosine,
    )


def entries_of(components, z, noise):
    """Range, bearing and their variances, whatever their order in z."""
    r, b = components.index("range"), components.index("bearing")
    return z[r, 0], z[b, 0], noise[r, r], noise[b, b]
