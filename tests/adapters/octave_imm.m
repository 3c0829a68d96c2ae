% An IMM filter in GNU Octave or MATLAB under test, through files.
%
%   immaculate cases copy problems
%   octave --no-gui --eval "addpath('tests/adapters'); octave_imm('problems', 'answers')"
%   immaculate check --answers answers
%
% octave_imm(problems, answers) reads each problem of the folder `problems` and writes `answers/ID.csv`, the long
% form with one number a line; octave_imm(problems, answers, 'json') writes `answers/ID.json`. In Octave prefer the
% CSV: its jsonencode writes numbers below 2.2e-16 as 0, small probabilities too.
%
% The first half is the adapter: files, and the mapping between the JSON and the filter's arguments. To
% check a filter of your own, keep it and change the lines marked CHANGE HERE. The second half is the filter.

function octave_imm(problems, answers, form)
  if nargin < 3
    form = 'csv';
  end
  if ~exist(answers, 'dir')
    mkdir(answers);
  end
  ready.name = 'Octave example';                       % CHANGE HERE
  ready.kinds = {'kalman', 'cubature-3', 'converted'}; % CHANGE HERE: which filters there are
  ready.validates = false;                             % problems that must be rejected are not asked for
  write_text(fullfile(answers, 'ready.json'), jsonencode(ready));
  files = dir(fullfile(problems, '*.problem.json'));
  for f = 1:numel(files)
    problem = jsondecode(fileread(fullfile(problems, files(f).name)));
    if ~strcmp(problem.format, 'immaculate-problem/1') || ~any(strcmp(kind_of(problem), ready.kinds))
      continue
    end
    try
      steps = run(problem);
    catch reason
      fprintf(2, '%s: %s\n', files(f).name, reason.message);
      continue
    end
    if strcmp(form, 'csv')
      write_csv(fullfile(answers, [problem.id '.csv']), problem.id, steps);
    else
      answer = struct('id', problem.id, 'steps', {steps});
      write_text(fullfile(answers, [problem.id '.json']), jsonencode(answer));
    end
  end
end

% The filter's name in ready.json
function kind = kind_of(problem)
  kind = problem.filter.kind;
  if strcmp(kind, 'cubature')
    kind = problem.filter.rule;
  end
end

% A problem, step by step. CHANGE HERE: how your filter is made, stepped and looked into.
%
% What jsondecode makes of JSON: a matrix is a matrix, [[5]] the scalar 5, a list of numbers a column, null
% is []; a list of objects with the same keys is a struct array, with a single object too.
function steps = run(problem)
  imm.F = {problem.modes.F};
  imm.Q = {problem.modes.Q};
  imm.R = problem.R;
  imm.measurement = problem.measurement;
  imm.has_points = strcmp(problem.filter.kind, 'cubature');
  imm.conversion = '';                                 % of ranges and bearings to positions
  if strcmp(problem.filter.kind, 'converted')
    imm.conversion = problem.filter.conversion;
    imm.polar = problem.measurement;
    imm.polar.R = problem.R;
    H = eye(numel(problem.state));
    imm.measurement = struct('kind', 'linear', 'H', H(problem.measurement.position + 1, :));
  end
  imm.transition = problem.transition;                 % transition(i, j): from i to j
  imm.probabilities = problem.initial.mode_probabilities;
  imm.means = {problem.initial.modes.mean};
  imm.covariances = {problem.initial.modes.covariance};
  steps = cell(1, numel(problem.measurements));
  for k = 1:numel(steps)
    [imm, shown] = step(imm, problem.measurements(k).z);
    shown.step = k;
    steps{k} = shown;
  end
end

% The long form
function write_csv(name, id, steps)
  file = fopen(name, 'w');
  fprintf(file, 'id,step,mode,quantity,row,column,value\n');
  for k = 1:numel(steps)
    write_quantities(file, id, k, '', '', rmfield(steps{k}, {'step', 'modes'}));
    for j = 1:numel(steps{k}.modes)
      write_quantities(file, id, k, num2str(j), '', steps{k}.modes{j});
    end
  end
  fclose(file);
end

function write_quantities(file, id, k, mode, prefix, shown)
  names = fieldnames(shown);
  for q = 1:numel(names)
    value = shown.(names{q});
    name = [prefix names{q}];
    if isstruct(value)
      write_quantities(file, id, k, mode, [name '.'], value);
      continue
    end
    for row = 1:size(value, 1)
      for column = 1:size(value, 2)
        fprintf(file, '%s,%d,%s,%s,%d,%d,%.17g\n', id, k, mode, name, row, column, value(row, column));
      end
    end
  end
end

function write_text(name, text)
  file = fopen(name, 'w');
  fprintf(file, '%s\n', text);
  fclose(file);
end

% ----------------------------------------------------------------------------------------------- the filter

% One step of the IMM filter; z is empty without a detection.
function [imm, shown] = step(imm, z)
  r = numel(imm.F);
  c = imm.transition' * imm.probabilities;             % predicted mode probabilities
  shown.predicted_mode_probabilities = c;
  shown.modes = cell(1, r);
  x = cell(1, r);
  P = cell(1, r);
  log_likelihoods = zeros(r, 1);
  for j = 1:r
    if c(j) > 0
      weights = imm.transition(:, j) .* imm.probabilities / c(j);
    else
      weights = double((1:r)' == j);                   % cannot be reached: it keeps its own estimate
    end
    [x{j}, P{j}] = mixture(weights, imm.means, imm.covariances);
    mode = struct('mixing_probabilities', weights, 'mixed', estimate(x{j}, P{j}));
    [x{j}, P{j}] = predict(imm, j, x{j}, P{j});
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
      [predicted_measurement, S, C] = measure(imm, x{j}, P{j});
      innovation = difference(imm.measurement, z, predicted_measurement);
      K = C / S;
      x{j} = x{j} + K * innovation;
      P{j} = P{j} - K * S * K';
      log_likelihoods(j) = -(innovation' * (S \ innovation) + log(det(2 * pi * S))) / 2;
      shown.modes{j}.predicted_measurement = predicted_measurement;
      shown.modes{j}.innovation = innovation;
      shown.modes{j}.innovation_covariance = S;
      shown.modes{j}.cross_covariance = C;
      shown.modes{j}.gain = K;
      shown.modes{j}.log_likelihood = log_likelihoods(j);
    end
    shown.modes{j}.updated = estimate(x{j}, P{j});
  end
  imm.probabilities = c;
  if ~isempty(z)
    imm.probabilities(c > 0) = c(c > 0) .* exp(log_likelihoods(c > 0) - max(log_likelihoods(c > 0)));
    imm.probabilities = imm.probabilities / sum(imm.probabilities);
  end
  imm.means = x;
  imm.covariances = P;
  shown.mode_probabilities = imm.probabilities;
  [mean, covariance] = mixture(imm.probabilities, x, P);
  shown.combined = estimate(mean, covariance);
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
  position = polar.sensor + factor * z(range) * axes(:, 1);
  covariance = axes * diag([along, across]) * axes';
end

% Predicted measurement, its covariance, and its covariance with the state
function [predicted, S, C] = measure(imm, x, P)
  if ~imm.has_points
    H = imm.measurement.H;
    predicted = H * x;
    C = P * H';
    S = H * C + imm.R;
    return
  end
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

% The points of the third-degree rule, one a column
function X = points(x, P)
  n = numel(x);
  root = sqrt(n) * chol(P, 'lower');
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
