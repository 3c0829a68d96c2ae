//! Figures read back from their SVG: shapes with colours, and panels with axes that turn values into pixels.

#![allow(clippy::float_cmp, reason = "axes stand at whole pixels, and widths are whole")]

/// Something that is drawn.
#[derive(Debug, Clone)]
pub struct Shape {
    /// `polyline`, `polygon`, `rect`, `circle` or `text`.
    pub kind: String,
    /// Its points; of a rectangle two corners, of a circle and a text one.
    pub points: Vec<(f64, f64)>,
    /// Of a line its stroke, else its fill.
    pub colour: String,
    pub opacity: f64,
    /// The width of a line's stroke.
    pub width: f64,
    /// The words of a text, and how it is anchored.
    pub words: String,
    anchor: String,
}

impl Shape {
    /// The middle between its extreme points.
    pub fn middle(&self) -> (f64, f64) {
        let middle = |of: fn(&(f64, f64)) -> f64| {
            let all = || self.points.iter().map(of);
            f64::midpoint(all().fold(f64::MAX, f64::min), all().fold(f64::MIN, f64::max))
        };
        (middle(|point| point.0), middle(|point| point.1))
    }
}

/// An axis: its labels, values and pixels, and what follows from those that are farthest apart.
#[derive(Debug, Clone)]
pub struct Axis {
    labels: Vec<(f64, f64)>,
    zero: f64,
    one: f64,
    /// Whether it is the decades of values that are evenly spaced.
    pub is_logarithmic: bool,
}

impl Axis {
    fn new(labels: Vec<(f64, f64)>, is_logarithmic: bool) -> Self {
        let place = |value: f64| if is_logarithmic { value.log10() } else { value };
        let by = |a: &&(f64, f64), b: &&(f64, f64)| a.0.total_cmp(&b.0);
        let ends = [labels.iter().min_by(by), labels.iter().max_by(by)]
            .map(|end| end.copied().unwrap_or((f64::NAN, f64::NAN)));
        let [first, last] = ends.map(|(value, pixel)| (place(value), pixel));
        let one = (last.1 - first.1) / (last.0 - first.0);
        Self {
            zero: first.1 - one * first.0,
            one,
            labels,
            is_logarithmic,
        }
    }

    /// The same labels on an axis of decades.
    pub fn logarithmic(&self) -> Self {
        Self::new(self.labels.clone(), true)
    }

    /// The pixel of a value.
    pub fn pixel(&self, value: f64) -> f64 {
        let place = if self.is_logarithmic { value.log10() } else { value };
        self.zero + self.one * place
    }

    /// The value, or the decade, at a pixel.
    pub fn place(&self, pixel: f64) -> f64 {
        (pixel - self.zero) / self.one
    }
}

/// A panel: its place and its axes.
#[derive(Debug, Clone)]
pub struct Frame {
    pub left: f64,
    pub right: f64,
    pub top: f64,
    pub bottom: f64,
    pub x: Axis,
    pub y: Axis,
}

impl Frame {
    /// The pixels of a point.
    pub fn at(&self, (x, y): (f64, f64)) -> (f64, f64) {
        (self.x.pixel(x), self.y.pixel(y))
    }

    /// What is drawn inside the panel, of a kind and colour.
    fn inside(&self, drawn: &[Shape], kind: &str, colour: &str) -> Vec<Shape> {
        const RIM: f64 = 9.0;
        let is_inside = |point: &(f64, f64)| {
            (self.left - RIM..=self.right + RIM).contains(&point.0)
                && (self.top - RIM..=self.bottom + RIM).contains(&point.1)
        };
        let is_of = |shape: &&Shape| shape.kind == kind && shape.colour == colour && shape.points.iter().all(is_inside);
        drawn.iter().filter(is_of).cloned().collect()
    }

    /// The lines of a colour, but for the axes and their marks.
    pub fn lines(&self, drawn: &[Shape], colour: &str) -> Vec<Shape> {
        let is_axis = |line: &Shape| {
            line.width == 1.0
                && line
                    .points
                    .iter()
                    .all(|point| point.0 <= self.left + 0.5 || point.1 >= self.bottom)
        };
        let lines = self.inside(drawn, "polyline", colour).into_iter();
        lines.filter(|line| !is_axis(line)).collect()
    }

    /// The marks and bands of a colour.
    pub fn polygons(&self, drawn: &[Shape], colour: &str) -> Vec<Shape> {
        self.inside(drawn, "polygon", colour)
    }

    /// The rectangles of a colour.
    pub fn rectangles(&self, drawn: &[Shape], colour: &str) -> Vec<Shape> {
        self.inside(drawn, "rect", colour)
    }

    /// Some points that are drawn are those values, and all of them: each is within a number of pixels of one of the others.
    pub fn assert_through(&self, points: &[(f64, f64)], values: &[(f64, f64)], pixels: f64) {
        let inside = |(x, y): (f64, f64)| (x, y.clamp(self.top, self.bottom));
        let expected: Vec<_> = values.iter().map(|value| inside(self.at(*value))).collect();
        let is_near = |a: &(f64, f64), b: &(f64, f64)| (a.0 - b.0).abs() <= pixels && (a.1 - b.1).abs() <= pixels;
        for (place, value) in expected.iter().zip(values) {
            assert!(
                points.iter().any(|point| is_near(point, place)),
                "nothing is drawn at {value:?}, which is {place:?}"
            );
        }
        for point in points {
            assert!(
                expected.iter().any(|place| is_near(point, place)),
                "what is drawn at {point:?} is no value"
            );
        }
    }

    /// There is one line of a colour that is more than a mark, and it goes through these values.
    pub fn assert_line(&self, drawn: &[Shape], colour: &str, values: &[(f64, f64)], pixels: f64) {
        let lines = self.lines(drawn, colour);
        let longest = lines.iter().max_by_key(|line| line.points.len());
        let Some(line) = longest else {
            panic!("no line of the colour {colour}")
        };
        let finite: Vec<_> = values.iter().copied().filter(|(_, value)| value.is_finite()).collect();
        self.assert_through(&line.points, &finite, pixels);
    }

    /// The dots of a colour stand at these places.
    pub fn assert_dots(&self, drawn: &[Shape], colour: &str, places: &[(f64, f64)], pixels: f64) {
        let dots = self.inside(drawn, "circle", colour);
        let centres: Vec<_> = dots.iter().map(|dot| dot.points[0]).collect();
        self.assert_through(&centres, places, pixels);
    }
}

/// Everything that is drawn, in the order in which it is.
pub fn shapes(svg: &str) -> Vec<Shape> {
    svg.split('<').skip(1).filter_map(shape).collect()
}

fn shape(element: &str) -> Option<Shape> {
    let kind = element.split([' ', '>']).next()?;
    let value = |name: &str| {
        let rest = element.split(&format!(" {name}=\"")).nth(1)?;
        rest.split('"').next()
    };
    let number = |name: &str| value(name).and_then(|text| text.parse::<f64>().ok());
    let points = match kind {
        "polyline" | "polygon" => value("points")?
            .split_whitespace()
            .map(point)
            .collect::<Option<Vec<_>>>()?,
        "rect" => {
            let (x, y) = (number("x")?, number("y")?);
            vec![(x, y), (x + number("width")?, y + number("height")?)]
        }
        "circle" => vec![(number("cx")?, number("cy")?)],
        "text" => vec![(number("x")?, number("y")?)],
        _ => return None,
    };
    let is_turned = element.contains("transform=");
    Some(Shape {
        points,
        colour: value(if kind == "polyline" { "stroke" } else { "fill" })?.to_owned(),
        opacity: number("opacity").unwrap_or(1.0),
        width: number("stroke-width").unwrap_or(0.0),
        words: element.split('>').nth(1).unwrap_or_default().trim().to_owned(),
        anchor: if is_turned {
            String::new()
        } else {
            format!(
                "{} {}",
                value("text-anchor").unwrap_or_default(),
                value("dy").unwrap_or_default()
            )
        },
        kind: kind.to_owned(),
    })
}

fn point(pair: &str) -> Option<(f64, f64)> {
    let (x, y) = pair.split_once(',')?;
    Some((x.parse().ok()?, y.parse().ok()?))
}

/// The rectangle that is seen at a pixel: the last that covers it, but for the ground.
pub fn rectangle_at(drawn: &[Shape], (x, y): (f64, f64)) -> Option<Shape> {
    let covers = |shape: &&Shape| match shape.points[..] {
        [from, to] => {
            shape.kind == "rect" && from != (0.0, 0.0) && (from.0..=to.0).contains(&x) && (from.1..=to.1).contains(&y)
        }
        _ => false,
    };
    drawn.iter().rev().find(covers).cloned()
}

/// The panels, row by row: each is known by its vertical axis, a thin line of ink, and the horizontal one that is drawn next.
pub fn frames(drawn: &[Shape]) -> Vec<Frame> {
    let axes = drawn
        .iter()
        .enumerate()
        .filter_map(|(place, shape)| match shape.points[..] {
            [from, to] if shape.kind == "polyline" && shape.width == 1.0 && shape.colour == "#000000" => {
                Some((place, from, to))
            }
            _ => None,
        });
    let axes: Vec<_> = axes.collect();
    let mut frames = Vec::new();
    for &(place, from, to) in axes
        .iter()
        .filter(|(_, from, to)| from.0 == to.0 && to.1 - from.1 > 50.0)
    {
        let horizontal = axes
            .iter()
            .find(|(other, start, end)| *other > place && start.1 == end.1 && end.0 - start.0 > 100.0);
        let &(_, start, end) = horizontal.expect("a panel has two axes");
        let (left, right, top, bottom) = (start.0, end.0, from.1, to.1);
        let labels = |anchor: &'static str, is_here: &dyn Fn((f64, f64)) -> bool| -> Vec<(f64, (f64, f64))> {
            let texts = drawn
                .iter()
                .filter(|shape| shape.kind == "text" && shape.anchor == anchor && is_here(shape.points[0]));
            texts
                .filter_map(|text| Some((text.words.parse::<f64>().ok()?, text.points[0])))
                .collect()
        };
        let across = labels("middle 0.76em", &|(x, y)| {
            (left - 3.0..=right + 3.0).contains(&x) && (bottom..bottom + 20.0).contains(&y)
        });
        let up = labels("end 0.5ex", &|(x, y)| {
            (left - 30.0..left).contains(&x) && (top - 3.0..=bottom + 3.0).contains(&y)
        });
        frames.push(Frame {
            left,
            right,
            top,
            bottom,
            x: Axis::new(across.iter().map(|(value, place)| (*value, place.0)).collect(), false),
            y: Axis::new(up.iter().map(|(value, place)| (*value, place.1)).collect(), false),
        });
    }
    frames
}
