% filter = mistaken_filter(mistake): example_filter with a mistake planted, to see what is said of it. 'another-turn' is none: a predicted
% bearing counts modulo 2 pi.
function filter = mistaken_filter(mistake)
  filter = example_filter();
  right = filter.step;
  filter.step = @(imm, now) step(right, mistake, imm, now);
end

function [imm, shown] = step(right, mistake, imm, now)
  switch mistake
    case 'transition-transposed'
      now.transition = now.transition';
    case 'stops'
      error('singular matrix');
  end
  [imm, shown] = right(imm, now);
  switch mistake
    case 'not-finite'
      shown.combined.mean(1) = NaN;
    case 'wrong-size'
      shown.combined.covariance = shown.combined.covariance(:, 1);
    case 'hidden'
      shown = struct();
    case 'another-turn'
      for j = 1:numel(shown.modes) * ~isempty(now.z)
        bearings = now.measurement.is_angle;
        shown.modes{j}.predicted_measurement(bearings) = shown.modes{j}.predicted_measurement(bearings) + 2 * pi;
      end
  end
end
