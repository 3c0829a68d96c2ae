//! stub
use super::arithmetic::Ball;
pub(super) fn pi(_p: i64) -> Option<Ball> {
    None
}
pub(super) fn exp(_x: &Ball, _p: i64) -> Option<Ball> {
    None
}
pub(super) fn ln(_x: &Ball, _p: i64) -> Option<Ball> {
    None
}
pub(super) fn sin(_x: &Ball, _p: i64) -> Option<Ball> {
    None
}
pub(super) fn cos(_x: &Ball, _p: i64) -> Option<Ball> {
    None
}
pub(super) fn atan2(_y: &Ball, _x: &Ball, _p: i64) -> Option<Ball> {
    None
}
