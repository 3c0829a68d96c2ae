% [imm, shown] = imm_step(imm, z): one step of an IMM filter in plain matrix code, for Octave or MATLAB; z is empty without a detection.
%
% Kalman filters, of converted measurements too, extended filters, or filters with the points of the third-degree cubature
% rule. It knows nothing of the protocol; example_filter.m says what imm has.
function [imm, shown] = imm_step(imm, z)
  r = numel(imm.F);
  c = imm.probabilities;                               % predicted mode probabilities
  if imm.mixes
    c = imm.transition' * imm.probabilities;
  end
  shown.predicted_mode_probabilities = c;
  shown.modes = cell(1, r);
  x = cell(1, r);
  P = cell(1, r);
  log_likelihoods = zeros(r, 1);
  for j = 1:r
    if imm.mixes && c(j) > 0
      weights = imm.transition(:, j) .* imm.probabilities / c(j);
    else
      weights = double((1:r)' == j);                   % cannot be reached: it keeps its own estimate
    end
    [x{j}, P{j}] = mixture(weights, imm.means, imm.covariances);
    mode = struct('mixing_probabilities', weights, 'mixed', estimate(x{j}, P{j}));
    if imm.is_extended
      mode.motion_jacobian = imm.F{j};                 % with a motion of your own: its slopes at x{j}
    end
    if imm.predicts
      [x{j}, P{j}] = predict(imm, j, x{j}, P{j});
    end
    mode.predicted = estimate(x{j}, P{j});
    shown.modes{j} = mode;
  end
  [mean, covariance] = mixture(c, x, P);
  shown.combined_prediction = estimate(mean, covariance);
  if ~isempty(z) && ~isempty(imm.conversion)
    [z, imm.R] = converted(imm.conversion, imm.polar, z);
    shown.converted_measurement = z;
    shown.converted_covariance = imm.R;
  end
  for j = 1:r
    if ~isempty(z)
      [shown.modes{j}, x{j}, P{j}] = update(imm, shown.modes{j}, x{j}, P{j}, z);
      log_likelihoods(j) = shown.modes{j}.log_likelihood;
    end
    shown.modes{j}.updated = estimate(x{j}, P{j});
  end
  imm.probabilities = c;
  if ~isempty(z)
    imm.probabilities(c > 0) = c(c > 0) .* exp(log_likelihoods(c > 0) - max(log_likelihoods(c > 0)));
    imm.probabilities = imm.probabilities / sum(imm.probabilities);
  end
  imm.mixes = true;                                    % in the first step these may be false
  imm.predicts = true;
  imm.means = x;
  imm.covariances = P;
  shown.mode_probabilities = imm.probabilities;
  [mean, covariance] = mixture(imm.probabilities, x, P);
  shown.combined = estimate(mean, covariance);
end

% A mode's estimate after the measurement, and what is shown on the way
function [mode, x, P] = update(imm, mode, x, P, z)
  [mode.predicted_measurement, S, C, H] = measure(imm, x, P);
  mode.innovation = difference(imm.measurement, z, mode.predicted_measurement);
  if imm.is_extended
    mode.measurement_jacobian = H;
  end
  K = C / S;
  mode.innovation_covariance = S;
  mode.cross_covariance = C;
  mode.gain = K;
  mode.nis = mode.innovation' * (S \ mode.innovation);
  mode.log_likelihood = -(mode.nis + log(det(2 * pi * S))) / 2;
  x = x + K * mode.innovation;
  P = P - K * S * K';
  P = (P + P') / 2;                                    % what is not symmetric is rounding, and would grow from step to step
end

function [mean, covariance] = predict(imm, j, x, P)
  F = imm.F{j};
  if imm.has_points
    X = F * points(x, P);
    mean = sum(X, 2) / size(X, 2);
    deviations = X - mean;
    covariance = deviations * deviations' / size(X, 2) + imm.Q{j};
  else
    mean = F * x;
    covariance = F * P * F' + imm.Q{j};
  end
end

% Range and bearing as a position with a covariance
function [position, covariance] = converted(name, polar, z)
  range = strcmp(polar.components, 'range');
  bearing = strcmp(polar.components, 'bearing');
  square = z(range) ^ 2;
  noise = polar.R(range, range);
  w = exp(-polar.R(bearing, bearing) / 2);
  along = (1 + w ^ 4) / 2 * (square + noise);          % variances along and across the line of sight
  across = (1 - w ^ 4) / 2 * (square + noise);
  switch name
    case 'standard'
      factor = 1;
      along = noise;
      across = square * polar.R(bearing, bearing);
    case 'additive'
      factor = 1 - (w ^ 2 - w);
      along = (1 + w ^ 8) / 2 * (square + 2 * noise) - w ^ 2 * along;
      across = (1 - w ^ 8) / 2 * (square + 2 * noise) - w ^ 2 * across;
    case 'multiplicative'
      factor = 1 / w;
      along = along + (w ^ -2 - 2) * square;
    case 'modified-unbiased'
      factor = w;
      along = along - w ^ 2 * square;
    otherwise
      error('no conversion %s', name);
  end
  axes = [cos(z(bearing)), -sin(z(bearing)); sin(z(bearing)), cos(z(bearing))];
  position = polar.sensor(:) + factor * z(range) * axes(:, 1);
  covariance = axes * diag([along, across]) * axes';
end

% Predicted measurement, its covariance, its covariance with the state, and its slopes where they are used
function [predicted, S, C, H] = measure(imm, x, P)
  if ~imm.has_points
    H = slopes_of(imm.measurement, x);
    predicted = measurement_of(imm.measurement, x);
    C = P * H';
    S = H * C + imm.R;
    return
  end
  H = [];
  X = points(x, P);
  Z = measurement_of(imm.measurement, X);
  centre = measurement_of(imm.measurement, x);
  deviations = difference(imm.measurement, Z, centre);
  shift = sum(deviations, 2) / size(X, 2);
  predicted = centre + shift;
  deviations = difference(imm.measurement, Z, predicted);
  S = deviations * deviations' / size(X, 2) + imm.R;
  C = (X - x) * deviations' / size(X, 2);
end

% The points of the third-degree rule, one a column. An entry without variance has a row of zeros in the root, too.
function X = points(x, P)
  n = numel(x);
  varies = any(P ~= 0, 2);
  root = zeros(n);
  root(varies, varies) = sqrt(n) * chol(P(varies, varies), 'lower');
  X = [x + root, x - root];
end

function Z = measurement_of(measurement, X)
  if strcmp(measurement.kind, 'linear')
    Z = measurement.H * X;
    return
  end
  dx = X(measurement.position(1) + 1, :) - measurement.sensor(1);
  dy = X(measurement.position(2) + 1, :) - measurement.sensor(2);
  components = measurement.components;
  Z = zeros(numel(components), size(X, 2));
  for row = 1:numel(components)
    if strcmp(components{row}, 'range')
      Z(row, :) = sqrt(dx .^ 2 + dy .^ 2);
    else
      Z(row, :) = atan2(dy, dx);
    end
  end
end

% The Jacobian of the measurement
function H = slopes_of(measurement, x)
  if strcmp(measurement.kind, 'linear')
    H = measurement.H;
    return
  end
  at = measurement.position + 1;
  d = x(at) - measurement.sensor(:);
  range = norm(d);
  H = zeros(numel(measurement.components), numel(x));
  for row = 1:size(H, 1)
    if strcmp(measurement.components{row}, 'range')
      H(row, at) = d' / range;
    else
      H(row, at) = [-d(2), d(1)] / range ^ 2;
    end
  end
end

% a - b, with its bearings wrapped to (-pi, pi]
function d = difference(measurement, a, b)
  d = a - b;
  if strcmp(measurement.kind, 'linear')
    return
  end
  bearings = strcmp(measurement.components, 'bearing');
  d(bearings, :) = d(bearings, :) - 2 * pi * ceil((d(bearings, :) - pi) / (2 * pi));
end

% Mean and covariance of a mixture of estimates
function [mean, covariance] = mixture(weights, means, covariances)
  mean = zeros(size(means{1}));
  for i = 1:numel(weights)
    mean = mean + weights(i) * means{i};
  end
  covariance = zeros(size(covariances{1}));
  for i = 1:numel(weights)
    spread = means{i} - mean;
    covariance = covariance + weights(i) * (covariances{i} + spread * spread');
  end
end

function object = estimate(mean, covariance)
  object = struct('mean', mean, 'covariance', covariance);
end
