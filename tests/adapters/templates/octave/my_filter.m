% my_filter(): a filter under test, for Octave or MATLAB. In this folder:
%
%   immaculate cases copy problems
%   octave-cli --eval "immaculate.run_folder('problems', 'answers', my_filter())"
%   immaculate check --answers answers
%
% It is a correct textbook interacting multiple model filter with Kalman filters. Replace it with your own: Immaculate sees only the parts
% marked CHANGE HERE. The folder +immaculate can stay as it is.
function filter = my_filter()
  filter.name = 'my filter';                           % CHANGE HERE
  filter.kinds = {'kalman'};                           % CHANGE HERE: which filters it has; `immaculate cases list` names them
  filter.formats = {'immaculate-problem/1'};
  filter.conventions = struct();
  filter.start = @start;
  filter.step = @step;
end

% CHANGE HERE: your filter from a problem
function mine = start(problem)
  % A single filter says here: if numel(problem.modes) > 1, error('immaculate:skipped', 'there is one mode only'); end
  mine.probabilities = problem.initial.mode_probabilities;
  mine.means = cellfun(@(mode) mode.mean, problem.initial.modes(:)', 'UniformOutput', false);
  mine.covariances = cellfun(@(mode) mode.covariance, problem.initial.modes(:)', 'UniformOutput', false);
end

% CHANGE HERE: one step of your filter. `now` has F{j} and Q{j} of each mode, the measurement's H, R, transition(i, j) from mode i to mode j,
% and z, which is empty without a detection. `shown` holds the values of your filter, from shown.combined alone to everything.
function [mine, shown] = step(mine, now)
  r = numel(now.F);
  c = now.transition' * mine.probabilities;
  x = cell(1, r);
  P = cell(1, r);
  log_likelihoods = zeros(r, 1);
  shown.predicted_mode_probabilities = c;
  shown.modes = cell(1, r);
  for j = 1:r                                          % mix, then predict
    if c(j) > 0
      weights = now.transition(:, j) .* mine.probabilities / c(j);
    else
      weights = double((1:r)' == j);                   % no mode leads to it: it keeps its own estimate
    end
    [x{j}, P{j}] = mixture(weights, mine.means, mine.covariances);
    mode = struct('mixing_probabilities', weights, 'mixed', estimate(x{j}, P{j}));
    x{j} = now.F{j} * x{j};
    P{j} = now.F{j} * P{j} * now.F{j}' + now.Q{j};
    mode.predicted = estimate(x{j}, P{j});
    shown.modes{j} = mode;
  end
  [mean, covariance] = mixture(c, x, P);
  shown.combined_prediction = estimate(mean, covariance);
  for j = 1:r                                          % update
    if ~isempty(now.z)
      H = now.measurement.H;
      mode = shown.modes{j};
      mode.predicted_measurement = H * x{j};
      mode.innovation = now.z - mode.predicted_measurement;
      mode.cross_covariance = P{j} * H';
      S = H * mode.cross_covariance + now.R;
      K = mode.cross_covariance / S;
      mode.innovation_covariance = S;
      mode.gain = K;
      mode.nis = mode.innovation' * (S \ mode.innovation);
      mode.log_likelihood = -(mode.nis + log(det(2 * pi * S))) / 2;
      log_likelihoods(j) = mode.log_likelihood;
      x{j} = x{j} + K * mode.innovation;
      P{j} = P{j} - K * S * K';
      P{j} = (P{j} + P{j}') / 2;                       % what is not symmetric is rounding, and would grow
      shown.modes{j} = mode;
    end
    shown.modes{j}.updated = estimate(x{j}, P{j});
  end
  mine.means = x;
  mine.covariances = P;
  mine.probabilities = c;
  if ~isempty(now.z)                                   % weigh: in logarithms, for likelihoods may all be zero as doubles
    mine.probabilities(c > 0) = c(c > 0) .* exp(log_likelihoods(c > 0) - max(log_likelihoods(c > 0)));
    mine.probabilities = mine.probabilities / sum(mine.probabilities);
  end
  shown.mode_probabilities = mine.probabilities;
  [mean, covariance] = mixture(mine.probabilities, x, P);
  shown.combined = estimate(mean, covariance);
end

% Mean and covariance of a mixture, the spread of its means included
function [mean, covariance] = mixture(weights, means, covariances)
  mean = zeros(size(means{1}));
  for i = 1:numel(weights)
    mean = mean + weights(i) * means{i};
  end
  covariance = zeros(numel(mean));
  for i = 1:numel(weights)
    covariance = covariance + weights(i) * (covariances{i} + (means{i} - mean) * (means{i} - mean)');
  end
end

function one = estimate(mean, covariance)
  one = struct('mean', mean, 'covariance', covariance);
end
