% SPDX-License-Identifier: GPL-3.0-or-later
% A tank that begins to leak, supervised from MATLAB: supervise('tank.json')
% The folders of libcordon_c.so, cordon.h and cordon_matlab.h are on the path of MATLAB.
function supervise(study)
  if ~libisloaded('cordon')
    loadlibrary('libcordon_c', 'cordon_matlab.h', 'addheader', 'cordon.h', 'alias', 'cordon');
  end
  session = calllib('cordon', 'cordon_open', study, '', '');
  if isNull(session)
    error(calllib('cordon', 'cordon_last_error'));
  end
  closing = onCleanup(@() calllib('cordon', 'cordon_close', session));
  level = 1;
  for k = 0:59
    inflow = 0.2 + 0.05 * sin(0.3 * k);
    gauge = level + 0.015 * sin(1.7 * k);
    if calllib('cordon', 'cordon_step', session, inflow, 1, gauge, 1) ~= 0
      error(calllib('cordon', 'cordon_last_error'));
    end
    for i = 0:calllib('cordon', 'cordon_change_count', session) - 1
      disp(calllib('cordon', 'cordon_change_text', session, i));
    end
    if k < 40
      level = 0.8 * level + inflow;
    else
      level = 0.7 * level + inflow;  % a leak
    end
  end
  [code, ~, lower, upper] = calllib('cordon', 'cordon_result_bounds', session, 0, 0, 0, 1);
  if code ~= 0
    error(calllib('cordon', 'cordon_last_error'));
  end
  name = 'unknown';
  mode = calllib('cordon', 'cordon_result_mode', session, 0);
  if mode ~= -1
    name = calllib('cordon', 'cordon_mode_name', session, mode);
  end
  k = calllib('cordon', 'cordon_last_k', session);
  fprintf('k = %d: mode %s, level from %.2f to %.2f m\n', k, name, lower, upper);
end
