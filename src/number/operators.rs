//! The operators `+ − × ÷` of a number system: by value, by reference and in place, all from one method each.
//!
//! Five methods define all twenty-six operators.
//!
//! A number system that is built upon another, such as the dual numbers over any field, names the other in brackets:
//! `ring_operators!(Dual<T> [T: Field])`.
//!
//! A number system writes the methods `plus`, `minus`, `times`, `negative` and, if it can divide, `over`, with the
//! mathematics in them; what follows is only the wiring that Rust and nalgebra ask for. It is a macro because a
//! function cannot implement a trait, and a blanket implementation of a foreign trait is not allowed.

/// Implements `+`, `−` and `×` from the methods `plus`, `minus`, `times` and `negative` of a type.
macro_rules! ring_operators {
    ($number:ty $([$($over:tt)*])?) => {
        $crate::number::operators::binary_operator!($number $([$($over)*])?, Add, add, AddAssign, add_assign, plus);
        $crate::number::operators::binary_operator!($number $([$($over)*])?, Sub, sub, SubAssign, sub_assign, minus);
        $crate::number::operators::binary_operator!($number $([$($over)*])?, Mul, mul, MulAssign, mul_assign, times);

        impl$(<$($over)*>)? std::ops::Neg for $number {
            type Output = $number;
            fn neg(self) -> $number {
                self.negative()
            }
        }

        impl$(<$($over)*>)? std::ops::Neg for &$number {
            type Output = $number;
            fn neg(self) -> $number {
                self.negative()
            }
        }
    };
}

/// Implements `÷` from the method `over` of a type.
macro_rules! division_operators {
    ($number:ty $([$($over:tt)*])?) => {
        $crate::number::operators::binary_operator!($number $([$($over)*])?, Div, div, DivAssign, div_assign, over);
    };
}

/// Implements one binary operator, by value, by reference and in place, from the method of that meaning.
macro_rules! binary_operator {
    ($number:ty $([$($over:tt)*])?, $operator:ident, $function:ident, $in_place:ident, $in_place_function:ident, $meaning:ident) => {
        impl$(<$($over)*>)? std::ops::$operator for $number {
            type Output = $number;
            fn $function(self, other: $number) -> $number {
                self.$meaning(&other)
            }
        }

        impl$(<$($over)*>)? std::ops::$operator<&$number> for &$number {
            type Output = $number;
            fn $function(self, other: &$number) -> $number {
                self.$meaning(other)
            }
        }

        impl$(<$($over)*>)? std::ops::$operator<&$number> for $number {
            type Output = $number;
            fn $function(self, other: &$number) -> $number {
                self.$meaning(other)
            }
        }

        impl$(<$($over)*>)? std::ops::$operator<$number> for &$number {
            type Output = $number;
            fn $function(self, other: $number) -> $number {
                self.$meaning(&other)
            }
        }

        impl$(<$($over)*>)? std::ops::$in_place for $number {
            fn $in_place_function(&mut self, other: $number) {
                *self = self.$meaning(&other);
            }
        }

        impl$(<$($over)*>)? std::ops::$in_place<&$number> for $number {
            fn $in_place_function(&mut self, other: &$number) {
                *self = self.$meaning(other);
            }
        }
    };
}

pub(crate) use {binary_operator, division_operators, ring_operators};
