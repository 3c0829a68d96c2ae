% sentences = immaculate.compare(problem, trace, answer): what is wrong in an answer, a sentence for each value, as computed.
%
% trace is that of `immaculate cases copy`, by jsondecode. A value is wrong if its error is more than 100 times the rounding noise, as
% `immaculate check` counts it: the noise is at least a unit roundoff of the value's scale and of the value itself.
function sentences = compare(problem, trace, answer)
  steps = immaculate.cells(trace.steps);
  scales = immaculate.cells(trace.scale);
  noises = immaculate.cells(trace.noise);
  list = quantities();
  sentences = {};
  is_shown = false;
  for k = 1:min(numel(steps), numel(answer.steps))
    [shown, is_there] = values(answer.steps{k}, list, numel(problem.modes));
    [right, is_known] = values(steps{k}, list, numel(problem.modes));
    scale = values(scales{k}, list, numel(problem.modes));
    noise = values(noises{k}, list, numel(problem.modes));
    both = (is_there & is_known)';                     % not a gain without a detection, for example
    is_shown = is_shown || any(both(:));
    for place = find(both(:))'
      [j, q] = ind2sub(size(both), place);
      units = struct('scale', scale{q, j}, 'noise', noise{q, j});
      units.is_unused = list{q, 2} && steps{k}.predicted_mode_probabilities(j) == 0;
      sentence = difference(shown{q, j}, right{q, j}, units, angles(problem, k, list{q, 1}));
      if ~isempty(sentence)
        sentences{end + 1} = [place_of(problem, k, j, list(q, :)) sentence];
      end
    end
  end
  if isfield(answer, 'error')
    sentences{end + 1} = ['it stopped: ' answer.error];
  elseif ~is_shown
    sentences{end + 1} = 'no value is shown';
  end
end

% What can be shown, in the order in which it is computed: its name, whether each mode has one, and its name in two parts.
function list = quantities()
  of_modes = {'mixing_probabilities', 'mixed.mean', 'mixed.covariance', 'predicted.mean', 'motion_jacobian', 'predicted.covariance', ...
    'predicted_measurement', 'innovation', 'measurement_jacobian', 'innovation_covariance', 'cross_covariance', 'gain', ...
    'updated.mean', 'updated.covariance', 'log_likelihood', 'nis'};
  names = [{'predicted_mode_probabilities'}, of_modes(1:6), {'combined_prediction.mean', 'combined_prediction.covariance', ...
    'converted_measurement', 'converted_covariance'}, of_modes(7:end), {'mode_probabilities', 'combined.mean', 'combined.covariance'}];
  list = cell(numel(names), 3);
  for q = 1:numel(names)
    list(q, :) = {names{q}, any(strcmp(names{q}, of_modes)), strsplit(names{q}, '.')};
  end
end

% The values of a step, found{q, j}, and which are there; a null is NaN. What is of all modes together has j = 1.
function [found, is_there] = values(step, list, mode_count)
  found = cell(size(list, 1), mode_count);
  is_there = false(size(found));
  modes = {};
  if isfield(step, 'modes')
    modes = immaculate.cells(step.modes);
  end
  for q = 1:size(list, 1)
    holders = {step};
    if list{q, 2}
      holders = modes;
    end
    for j = 1:numel(holders)
      value = holders{j};
      is_there(q, j) = true;
      for name = list{q, 3}
        is_there(q, j) = is_there(q, j) && isfield(value, name{1});
        if is_there(q, j)
          value = value.(name{1});
        end
      end
      if isempty(value)
        value = NaN;
      end
      found{q, j} = value;
    end
  end
end

function text = place_of(problem, k, j, quantity)
  text = sprintf('%s, step %d', quantity{1}, k);
  if quantity{2}
    text = sprintf('%s, mode %d (%s)', text, j, problem.modes{j}.name);
  end
end

% What is wrong with a value; empty if nothing is.
function sentence = difference(shown, right, units, is_angle)
  sentence = '';
  if ~isequal(size(shown), size(right)) && ~(isvector(shown) && isvector(right) && numel(shown) == numel(right))
    sentence = sprintf(': it has the size %s, not %s', mat2str(size(shown)), mat2str(size(right)));
    return
  end
  % Where rounding is as large as the value's unit nobody can tell, and no output depends on a mode of probability zero.
  if all(isfinite(shown(:))) && (~(100 * units.noise <= 1) || units.is_unused)
    return
  end
  ratio = ratios(shown(:), right(:), units, is_angle);
  i = find(ratio > 100, 1);
  if ~isempty(i)
    [row, column] = ind2sub(size(right), i);
    sentence = sprintf(', (%d,%d): %.17g is shown, %.17g is certified: %.2g times the rounding noise, of which 100 are allowed', ...
      row, column, shown(i), right(i), ratio(i));
  end
end

% The errors in rounding noise.
function ratio = ratios(shown, right, units, is_angle)
  roundoff = eps / 2;
  error = abs(shown - right);
  error(is_angle) = abs(error(is_angle) - 2 * pi * round(error(is_angle) / (2 * pi)));
  least = max(roundoff * abs(right), realmin * eps);
  ratio = error ./ max(max(units.noise, roundoff) * units.scale(:), least);
  ratio(isnan(ratio)) = Inf;
  % A log-likelihood below the least double is null in JSON.
  ratio(isnan(right) & ~isfinite(shown)) = 0;
end

% Which entries count modulo 2 pi: angles in means of the state, and in what a sensor is predicted to measure.
function rows = angles(problem, k, quantity)
  rows = [];
  if numel(quantity) > 5 && strcmp(quantity(end - 4:end), '.mean')
    rows = find(problem.is_angle);
  elseif strcmp(quantity, 'predicted_measurement') && ~strcmp(problem.filter.kind, 'converted')
    now = immaculate.step_of(problem, k);
    rows = find(now.measurement.is_angle);
  end
end
