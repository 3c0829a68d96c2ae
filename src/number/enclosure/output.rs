//! Reading an enclosure: its ends, the double and the decimal that it determines, its size and width.
//!
//! An enclosure that is too wide to determine a double or a digit says so.

use super::dyadic::Dyadic;
use super::{Ball, Enclosure, Field, Rational};
use std::cmp::Ordering;
use std::fmt;

impl Enclosure {
    /// The lower end, exactly; undecided if the enclosure is, or if the end is beyond 2 to the power ±2²⁴ (it would fill megabytes).
    pub fn lower(&self) -> Rational {
        self.end(Ball::lower)
    }

    /// The upper end, exactly; undecided as [`Enclosure::lower`].
    pub fn upper(&self) -> Rational {
        self.end(Ball::upper)
    }

    fn end(&self, of: impl Fn(&Ball) -> Dyadic) -> Rational {
        let end = self.ball.as_ref().and_then(|ball| of(ball).to_rational());
        end.unwrap_or_else(Rational::undecided)
    }

    /// Whether the number is in the enclosure; false if either is undecided.
    pub fn contains(&self, value: &Rational) -> bool {
        let (Some(ball), Some(value)) = (&self.ball, value.value()) else {
            return false;
        };
        ball.lower().compare_with(value) != Ordering::Greater && ball.upper().compare_with(value) != Ordering::Less
    }

    /// The double that is nearest to every number of the enclosure, ties to the even one; none if there is no single one, or if it
    /// would be infinite. Zero has no sign.
    ///
    /// Evidence: `the_double_of_an_enclosure_is_the_nearest_one`.
    pub fn to_f64(&self) -> Option<f64> {
        let ball = self.ball.as_ref()?;
        let low = ball.lower().nearest_double();
        // Rounding to the nearest is monotone, so what both ends round to all numbers between them do.
        let is_one = ball.is_exact() || low.to_bits() == ball.upper().nearest_double().to_bits();
        (is_one && low.is_finite()).then_some(low)
    }

    /// The decimal with a number of significant digits that is nearest to every number of the enclosure, ties to the even one, in
    /// scientific notation such as `-1.234567e-3`; `0` for exactly zero. None if there is no single one, or if the number is
    /// beyond 2 to the power ±2²⁴. No digits count as one.
    ///
    /// Evidence: `the_decimal_of_an_enclosure_is_the_nearest_one`.
    pub fn to_decimal(&self, digits: u32) -> Option<String> {
        let ball = self.ball.as_ref()?;
        // Log₁₀ 2 = 0.301: digits beyond the certain bits cannot be determined, and are not worth computing.
        if !ball.is_exact() && i64::from(digits) > self.relative_bits().max(0) / 3 + 9 {
            return None;
        }
        let low = ball.lower().to_decimal(digits)?;
        (ball.is_exact() || ball.upper().to_decimal(digits)? == low).then_some(low)
    }

    /// The middle itself, with radius zero: a number of as many bits as the enclosure has. [`Enclosure::width`] bounds what it leaves out.
    ///
    /// Example: a third in 100 bits is the point that it was rounded to.
    ///
    /// ```
    /// use immaculate::number::{Enclosure, Field};
    ///
    /// let third = Enclosure::with_precision(100, || Enclosure::integer(1) / Enclosure::integer(3));
    /// let centre = third.centre();
    /// assert!(centre.width() == 0.0 && third.width() > 0.0 && third.contains(&centre.lower()));
    /// ```
    #[must_use]
    pub fn centre(&self) -> Self {
        let ball = self.ball.as_ref().map(|ball| Ball::exact(ball.middle.clone()));
        Self { ball }
    }

    /// The double nearest to the middle of the enclosure; NaN if undecided.
    pub fn middle(&self) -> f64 {
        self.ball.as_ref().map_or(f64::NAN, |ball| ball.middle.nearest_double())
    }

    /// A double that is not below the magnitude of any number of the enclosure, and the least of them; ∞ beyond all doubles, NaN
    /// if undecided.
    pub fn magnitude(&self) -> f64 {
        self.ball.as_ref().map_or(f64::NAN, |ball| {
            ball.middle.abs().plus_bound(ball.radius).double_above()
        })
    }

    /// A double that is not below the distance of the two ends; zero only for a point, and else at least the least normal double.
    /// ∞ beyond all doubles, NaN if undecided.
    pub fn width(&self) -> f64 {
        self.ball.as_ref().map_or(f64::NAN, |ball| {
            if ball.is_exact() {
                return 0.0;
            }
            let width = Dyadic::zero().plus_bound(ball.radius.shifted(1));
            width.double_above().max(f64::MIN_POSITIVE)
        })
    }

    /// How many leading bits are certain, ⌊log₂(|x|/r)⌋ for midpoint x and radius r: negative if zero is well inside,
    /// `i64::MAX` for a point, `i64::MIN` if undecided or around zero exactly.
    pub fn relative_bits(&self) -> i64 {
        let Some(ball) = &self.ball else {
            return i64::MIN;
        };
        if ball.is_exact() {
            return i64::MAX;
        }
        if ball.middle.is_zero() {
            return i64::MIN;
        }
        let difference = ball.middle.top() - ball.radius.top();
        let radius = Dyadic::zero().plus_bound(ball.radius.shifted(difference));
        difference - i64::from(ball.middle.abs().compare(&radius) == Ordering::Less)
    }
}

impl fmt::Display for Enclosure {
    /// The midpoint, with as many digits as are certain and two more, and the radius.
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Some(ball) = &self.ball else {
            return formatter.pad("undecided");
        };
        let written = |number: &Dyadic, digits| {
            let power = || format!("{}·2^{}", number.mantissa, number.exponent);
            number.to_decimal(digits).unwrap_or_else(power)
        };
        if ball.is_exact() {
            return formatter.pad(&written(&ball.middle, 17));
        }
        // log₁₀ 2 = 0.30103.
        let digits = self.relative_bits().clamp(0, 1 << 20) * 30103 / 100_000 + 2;
        let middle = written(&ball.middle, u32::try_from(digits).unwrap_or(u32::MAX));
        let radius = written(&Dyadic::zero().plus_bound(ball.radius), 2);
        formatter.pad(&format!("{middle} ± {radius}"))
    }
}

impl fmt::Debug for Enclosure {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, formatter)
    }
}
