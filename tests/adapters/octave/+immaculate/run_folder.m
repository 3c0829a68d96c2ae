% immaculate.run_folder(problems, answers, filter): answers each problem of a folder that a filter is asked for, for `immaculate check`.
%
%   immaculate cases copy problems
%   octave-cli --eval "addpath('tests/adapters/octave'); immaculate.run_folder('problems', 'answers', example_filter())"
%   immaculate check --answers answers
%
% It uses files because a pipe would hang: Octave's fgetl and fgets wait for the line after the one that they return, so a program under
% `immaculate check -- octave-cli ...` would wait for a message that comes only after its answer. immaculate.run_problem describes a
% filter. immaculate.run_folder(problems, answers, filter, 'csv') writes tables instead of JSON.
function run_folder(problems, answers, filter, form)
  if nargin < 4
    form = 'json';
  end
  if ~exist(answers, 'dir')
    mkdir(answers);
  end
  ready = struct('name', filter.name, 'validates', false); % problems that must be rejected are not asked for
  ready.kinds = filter.kinds;
  ready.formats = filter.formats;
  ready.conventions = filter.conventions;
  file = fopen(fullfile(answers, 'ready.json'), 'w');
  fprintf(file, '%s\n', jsonencode(ready));
  fclose(file);
  files = dir(fullfile(problems, '*.problem.json'));
  if isempty(files)
    error('immaculate:folder', '%s has no problem; `immaculate cases copy %s` writes them', problems, problems);
  end
  for f = 1:numel(files)
    problem = immaculate.read_problem(fullfile(problems, files(f).name));
    if immaculate.is_asked(filter, problem)
      immaculate.write_answer(answers, immaculate.run_problem(filter, problem), form);
    end
  end
end
