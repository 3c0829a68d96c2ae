% answer = immaculate.run_problem(filter, problem): runs a filter on a problem as far as it goes.
%
% filter is a struct:
%
%   name, kinds, formats   the name of the program, its kinds of filter, and the problem formats that it reads
%   conventions            those that differ from the cases': struct('first_step', 'unmixed'), or struct()
%   start                  imm = start(problem): your filter at step 0
%   step                   [imm, shown] = step(imm, now): one step; `now` is from immaculate.step_of
%
% start finds the declared conventions in problem.conventions. An error with the identifier immaculate:skipped says what the filter
% cannot do; any other error becomes the answer's error with its step. shown has the filter's values under the names of spec/formats.md:
% shown.combined.mean, shown.modes{j}.mixed.covariance, ...
function answer = run_problem(filter, problem)
  answer = struct('type', 'answer', 'id', problem.id);
  answer.steps = {};
  names = fieldnames(filter.conventions);
  for c = 1:numel(names)
    problem.conventions.(names{c}) = filter.conventions.(names{c});
  end
  place = '';
  try
    imm = filter.start(problem);
    for k = 1:numel(problem.measurements)
      place = sprintf('step %d: ', k);
      [imm, shown] = filter.step(imm, immaculate.step_of(problem, k));
      shown.step = k;
      answer.steps{k} = shown;
    end
  catch reason
    if strcmp(reason.identifier, 'immaculate:skipped')
      answer = struct('type', 'skipped', 'id', problem.id, 'reason', reason.message);
    else
      answer.error = [place reason.message];
    end
  end
end
