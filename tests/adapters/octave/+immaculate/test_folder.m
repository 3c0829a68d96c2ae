% results = immaculate.test_folder(problems, filter): each certified case of a folder as a test, in Octave and in MATLAB.
%
%   immaculate cases copy problems
%   octave-cli --eval "addpath('tests/adapters/octave'); immaculate.test_folder('problems', example_filter())"
%
% results is a struct array with the names that matlab.unittest.TestResult has: Name, Passed, Failed, Incomplete (what the filter skips),
% and Details.DiagnosticRecord, the sentences, each with equation, step and mode. Without an output argument, a failure is an
% error, so that the command ends with status 1. Only the first failures of a case are printed; later ones may follow from them.
function results = test_folder(problems, filter)
  files = dir(fullfile(problems, '*.problem.json'));
  found = struct('Name', {}, 'Passed', {}, 'Failed', {}, 'Incomplete', {}, 'Details', {});
  if ~isempty(fieldnames(filter.conventions))
    error('immaculate:folder', 'a filter of other conventions is judged by `immaculate check` alone');
  end
  for f = 1:numel(files)
    problem = immaculate.read_problem(fullfile(problems, files(f).name));
    trace = jsondecode(fileread(fullfile(problems, strrep(files(f).name, '.problem.json', '.trace.json'))));
    if immaculate.is_asked(filter, problem) && isfield(trace, 'steps')
      found(end + 1) = test_case(filter, problem, trace);
    end
  end
  if isempty(found)
    error('immaculate:folder', '%s has no certified case for this filter; `immaculate cases copy %s` writes them', problems, problems);
  end
  fprintf('Totals:\n   %d Passed, %d Failed, %d Incomplete.\n', sum([found.Passed]), sum([found.Failed]), sum([found.Incomplete]));
  if nargout > 0
    results = found;
  elseif any([found.Failed])
    error('immaculate:failed', '%d of %d cases failed', sum([found.Failed]), numel(found));
  end
end

function result = test_case(filter, problem, trace)
  answer = immaculate.run_problem(filter, problem);
  result = struct('Name', problem.id, 'Passed', false, 'Failed', false, 'Incomplete', strcmp(answer.type, 'skipped'));
  if result.Incomplete
    sentences = {answer.reason};
    fprintf('%s was filtered: %s\n', problem.id, answer.reason);
  else
    sentences = immaculate.compare(problem, trace, answer);
    result.Passed = isempty(sentences);
    result.Failed = ~result.Passed;
  end
  result.Details = struct('DiagnosticRecord', {sentences});
  if result.Failed
    fprintf('Verification failed in %s.\n', problem.id);
    fprintf('   %s\n', sentences{1:min(5, end)});
  end
end
