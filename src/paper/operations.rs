//! The cost of one cycle of the papers' filters, as closed formulas.
//!
//! These are the operation counts for each filter whose cost derbez2000 or sustika2015 prints or compares, with the convention and the
//! parts.
//!
//! An operation is +, −, ×, ÷, √ or one of exp, ln, sin, cos, atan2. A change of sign, a comparison and what depends on no data (2π, the
//! weights of a rule) are free. Every matrix is full: zeros and ones are numbers like any other. The papers' programs are not printed.
//! What is counted is a cycle of their equations as this crate computes them, from the estimates before to the combined estimate after.
//! The dimensions are n of the state and m of the measurement; a filter has two modes.

/// How a sum of n terms is counted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sums {
    /// n additions, the first into an empty sum: an n × m by m × p product takes 2nmp operations, as the function `flops` of MATLAB
    /// counted up to version 5.
    FromNothing,
    /// n − 1 additions: an n × m by m × p product takes n(2m − 1)p operations.
    FromFirstTerm,
}

impl Sums {
    /// Both conventions, from the one that counts most.
    pub const ALL: [Self; 2] = [Self::FromNothing, Self::FromFirstTerm];

    /// What the first term of a sum costs.
    fn first(self) -> usize {
        match self {
            Self::FromNothing => 1,
            Self::FromFirstTerm => 0,
        }
    }

    /// A sum of products, as many as there are terms.
    fn weighted_sum(self, terms: usize) -> usize {
        2 * terms - 1 + self.first()
    }

    /// An n × m by m × p product of matrices.
    fn product(self, n: usize, m: usize, p: usize) -> usize {
        n * p * self.weighted_sum(m)
    }

    /// Σ w (x − x̄)(y − ȳ)ᵀ without its sum over the terms: what one of them costs, of which the first deviation is given.
    fn moment(self, n: usize, m: usize) -> usize {
        self.product(n, 1, m) + n * m
    }

    /// The mean and the covariance of a mixture of two: Σ μ [P + (x̂ − x̄)(x̂ − x̄)ᵀ].
    fn mixture_mean(self, n: usize) -> usize {
        n * self.weighted_sum(2)
    }

    fn mixture_covariance(self, n: usize) -> usize {
        2 * (n + self.product(n, 1, n) + n * n) + n * n * self.weighted_sum(2)
    }

    /// c, μᵢ∣ⱼ (a product and a quotient each), relative likelihoods (a difference and an exponential each), C, μ (a product and a quotient
    /// each).
    fn probabilities(self) -> usize {
        self.product(2, 2, 1) + 2 * 4 + 2 * 2 + self.product(1, 2, 1) + 2 * 2
    }

    /// F P Fᵀ + Q.
    fn predicted_covariance(self, n: usize) -> usize {
        2 * self.product(n, n, n) + n * n
    }

    /// H x̂⁻, H P⁻ Hᵀ + R and P⁻ Hᵀ.
    fn linear_measurement(self, n: usize, m: usize) -> usize {
        let covariance = self.product(m, n, n) + self.product(m, n, m) + m * m;
        self.product(m, n, 1) + covariance + self.product(n, n, m)
    }

    /// ν, x̂⁻ + K ν.
    fn updated_mean(self, n: usize, m: usize) -> usize {
        m + self.product(n, m, 1) + n
    }

    /// P⁻ − K S Kᵀ.
    fn updated_covariance(self, n: usize, m: usize) -> usize {
        self.product(n, m, m) + self.product(n, m, n) + n * n
    }

    /// (I − K H) P⁻, which derbez2000 prints in (2).
    fn printed_covariance(self, n: usize, m: usize) -> usize {
        self.product(n, m, n) + n * n + self.product(n, n, n)
    }

    /// −½ (νᵀ S⁻¹ ν + ln |2πS|): factors of S, a triangular system, Σ y²/d, Σ ln 2πd, a sum and a factor.
    fn log_likelihood(self, m: usize) -> usize {
        factors(m) + m * (m - 1) + self.log_likelihood_of_fixed(m) + m + self.weighted_sum(m)
    }

    /// The same where ln |2πS| and the factors of S are known before the filter runs.
    fn log_likelihood_of_fixed(self, m: usize) -> usize {
        m + self.weighted_sum(m) + 2
    }

    /// A point on either side of the mean along each of n axes: a column of the root, scaled, and added. What stands above the diagonal,
    /// and a column of zeros, are added to nothing.
    fn axis_points(self, n: usize, columns: usize) -> usize {
        let entries: usize = (0..columns).map(|column| n - column).sum();
        2 * (2 * entries + (n * n - entries) * self.first())
    }
}

/// S = L D Lᵀ, and K from it, row by row: two triangular systems and a division by D.
fn gain(n: usize, m: usize) -> usize {
    factors(m) + n * (2 * m * (m - 1) + m)
}

/// The factors of S of one or two rows: with two, a quotient, two products and a difference.
fn factors(m: usize) -> usize {
    2 * m * (m - 1)
}

/// The square root of an n × n covariance, column by column: an entry of column k takes k products and differences, and a root or a
/// quotient.
fn root(n: usize, columns: usize) -> usize {
    (0..columns).map(|column| (n - column) * (2 * column + 1)).sum()
}

/// A filter whose operations derbez2000 counts, in one coordinate: three states, one measurement.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum OneCoordinate {
    /// The IMM filter with fixed gains.
    FixedGain,
    /// The Kalman filter of constant acceleration.
    ConstantAcceleration,
    /// The IMM filter of constant velocity and constant acceleration.
    Imm,
}

/// How the covariance is updated; the two are equal at the Kalman gain, and cost differently.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CovarianceUpdate {
    /// P⁻ − K S Kᵀ, this crate's.
    Short,
    /// (I − K H) P⁻, which derbez2000 prints.
    Printed,
}

impl CovarianceUpdate {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Short, Self::Printed];
}

impl OneCoordinate {
    /// The three filters, from the cheapest.
    pub const ALL: [Self; 3] = [Self::FixedGain, Self::ConstantAcceleration, Self::Imm];

    /// What the paper prints for both coordinates: in section 4, in section 4.1, in table 1. Section 4.1 names the filters in another
    /// order than the numbers.
    pub fn printed(self) -> [usize; 3] {
        match self {
            Self::FixedGain => [242, 242, 242],
            Self::ConstantAcceleration => [590, 590, 590],
            Self::Imm => [1332, 1322, 1326],
        }
    }

    /// The operations of a cycle for both coordinates, which are filtered one by one.
    ///
    /// Source: derbez2000, section 4, remark on the counting of operations.
    ///
    /// Example: fixed gains cost half of the Kalman filter where the update is the printed one. 590, which is printed, is more than either
    /// convention counts.
    ///
    /// ```
    /// use immaculate::paper::operations::{CovarianceUpdate::Printed, OneCoordinate, Sums};
    ///
    /// let both = |filter: OneCoordinate| Sums::ALL.map(|sums| filter.operations(Printed, sums));
    /// assert_eq!(both(OneCoordinate::FixedGain), [284, 228]);
    /// assert_eq!(both(OneCoordinate::ConstantAcceleration), [556, 456]);
    /// ```
    ///
    /// Evidence: `the_filters_cost_what_their_equations_cost` (exact).
    pub fn operations(self, update: CovarianceUpdate, sums: Sums) -> usize {
        let (n, m) = (3, 1);
        let prediction = sums.product(n, n, 1);
        let covariance = match update {
            CovarianceUpdate::Short => sums.updated_covariance(n, m),
            CovarianceUpdate::Printed => sums.printed_covariance(n, m),
        };
        let kalman = prediction
            + sums.predicted_covariance(n)
            + sums.linear_measurement(n, m)
            + gain(n, m)
            + sums.updated_mean(n, m)
            + covariance;
        // The mean of either mode is mixed, and the output is a mixture.
        let imm = sums.probabilities() + 3 * sums.mixture_mean(n);
        let one = match self {
            Self::ConstantAcceleration => kalman,
            Self::Imm => imm + 3 * sums.mixture_covariance(n) + 2 * (kalman + sums.log_likelihood(m)),
            Self::FixedGain => {
                let measured = sums.product(m, n, 1);
                imm + 2 * (prediction + measured + sums.updated_mean(n, m) + sums.log_likelihood_of_fixed(m))
            }
        };
        2 * one
    }
}

/// A filter of sustika2015: six states, range and bearing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CoastalRadar {
    /// IMM-CMKF.
    Converted,
    /// IMM-UKF as the paper has it: predicted by (14) and (15), with points for the measurement only.
    Unscented,
    /// IMM-UKF as it is run here: with points for the prediction too, which gives the same.
    UnscentedTwice,
}

impl CoastalRadar {
    /// The three filters.
    pub const ALL: [Self; 3] = [Self::Converted, Self::Unscented, Self::UnscentedTwice];

    /// The operations of a cycle.
    ///
    /// Source: sustika2015, section 5.3, which compares execution times.
    ///
    /// Example: points cost more than one converted position, and points for a linear motion more again, for the same estimate.
    ///
    /// ```
    /// use immaculate::paper::operations::{CoastalRadar, Sums};
    ///
    /// let costs = CoastalRadar::ALL.map(|filter| filter.operations(Sums::FromFirstTerm));
    /// assert_eq!(costs, [3881, 5248, 8790]);
    /// ```
    ///
    /// Evidence: `both_filters_of_the_coastal_radar_cost_what_their_equations_cost` (exact).
    pub fn operations(self, sums: Sums) -> usize {
        let (n, m, points) = (6, 2, 13);
        let common = sums.probabilities()
            + 3 * (sums.mixture_mean(n) + sums.mixture_covariance(n))
            + 2 * (sums.updated_mean(n, m) + gain(n, m) + sums.updated_covariance(n, m) + sums.log_likelihood(m));
        let linear_prediction = sums.product(n, n, 1) + sums.predicted_covariance(n);
        // h of the points and of their centre: two products, a sum, a root, an arcus tangent. Bearings are averaged about the centre's.
        let measured = 5 * (points + 1);
        let mean = m * sums.weighted_sum(points) + points + 1;
        // S starts from R, C from nothing.
        let covariance = points * (m + sums.moment(m, m) + m * m);
        let cross = points * (n + m + sums.moment(n, m)) + n * m * (points - 1 + sums.first());
        let measurement = measured + mean + covariance + cross;
        // Constant velocity has no acceleration: its square root has four columns.
        let drawn = |columns: usize| root(n, columns) + sums.axis_points(n, columns);
        let unscented = common + 2 * measurement + drawn(6) + drawn(4);
        match self {
            // z 4, and its two parts added to the radar's place, which is nothing; R 22.
            Self::Converted => {
                let conversion = 4 + 2 * sums.first() + 22;
                common + 2 * linear_prediction + conversion + 2 * sums.linear_measurement(n, m)
            }
            Self::Unscented => unscented + 2 * linear_prediction,
            // F of each point; the mean, and P⁻, which starts from Q.
            Self::UnscentedTwice => {
                let propagated = points * sums.product(n, n, 1);
                let moments = n * sums.weighted_sum(points) + points * (n + sums.moment(n, n) + n * n);
                unscented + 2 * (drawn(6) + propagated + moments)
            }
        }
    }

    /// The roots in a cycle; and exp, ln, sin, cos, atan2.
    ///
    /// A root for each range, of 13 points and of their centre in each mode, and for each pivot; an arcus tangent for each bearing; four
    /// logarithms and two exponentials of likelihoods; in the conversion cosine and sine twice and the exponential of its factor.
    pub fn roots_and_functions(self) -> [usize; 2] {
        let likelihoods = 4 + 2;
        let ranges = 2 * 14;
        match self {
            Self::Converted => [0, likelihoods + 5],
            Self::Unscented => [ranges + 6 + 4, likelihoods + ranges],
            Self::UnscentedTwice => [ranges + (6 + 6) + (6 + 4), likelihoods + ranges],
        }
    }
}
