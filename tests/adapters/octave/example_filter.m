% filter = example_filter(): the filter of imm_step.m as immaculate.run_folder and immaculate.test_folder take it.
%
% To check a filter of your own, keep the shape of this file and change the lines marked CHANGE HERE. example_filter('first_step',
% 'unmixed') declares another convention, and follows it.
function filter = example_filter(varargin)
  filter.name = 'Octave example';                                  % CHANGE HERE
  filter.kinds = {'kalman', 'extended', 'cubature-3', 'converted'}; % CHANGE HERE: which filters there are
  filter.formats = {'immaculate-problem/1', 'immaculate-problem/2'};
  filter.conventions = struct(varargin{:});
  filter.start = @start;
  filter.step = @step;
end

% CHANGE HERE: your filter from a problem
function imm = start(problem)
  if isfield(problem, 'conversions')
    error('immaculate:skipped', 'all modes have one state here');
  end
  for j = 1:numel(problem.modes)
    mode = problem.modes{j};
    if isfield(mode, 'filter')
      error('immaculate:skipped', 'there is one filter for all modes here');
    elseif isfield(mode, 'f') || isfield(mode, 'motion') || ~isnumeric(mode.Q)
      error('immaculate:skipped', 'there are no formulas and no named models here');
    end
  end
  imm.has_points = strcmp(problem.filter.kind, 'cubature');
  imm.is_extended = strcmp(problem.filter.kind, 'extended');
  imm.conversion = '';                                             % of ranges and bearings to positions
  if strcmp(problem.filter.kind, 'converted')
    imm.conversion = problem.filter.conversion;
  end
  imm.mixes = strcmp(problem.conventions.first_step, 'mixed');
  imm.predicts = ~strcmp(problem.conventions.first_step, 'predicted');
  imm.probabilities = problem.initial.mode_probabilities;
  imm.means = cellfun(@(mode) mode.mean, problem.initial.modes(:)', 'UniformOutput', false);
  imm.covariances = cellfun(@(mode) mode.covariance, problem.initial.modes(:)', 'UniformOutput', false);
end

% CHANGE HERE: one step of your filter. `now` is from immaculate.step_of; in format 1 its models are the same in all steps.
function [imm, shown] = step(imm, now)
  if ~any(strcmp(now.measurement.kind, {'linear', 'range-bearing'}))
    error('immaculate:skipped', 'there are no formulas and no named models here');
  end
  imm.F = now.F;
  imm.Q = now.Q;
  imm.R = now.R;
  imm.transition = now.transition;                                 % transition(i, j): from i to j
  imm.measurement = now.measurement;
  if ~isempty(imm.conversion)
    imm.polar = now.measurement;
    imm.polar.R = now.R;
    H = eye(numel(imm.means{1}));
    imm.measurement = struct('kind', 'linear', 'H', H(now.measurement.position + 1, :));
  end
  [imm, shown] = imm_step(imm, now.z);
end
