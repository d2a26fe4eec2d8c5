% The nearest hit of each ray: distance t (Inf for none) and the number of the sphere
% (0 for none). `from` is the number of the sphere a ray starts on, 0 for free space.
function [t, id] = intersect_scene(scene, origin, direction, from)
  count = rows(direction);
  t = Inf(count, 1);
  id = zeros(count, 1);
  for k = 1:rows(scene.centre)
    [near, far] = sphere_roots(origin, direction, scene.centre(k, :), scene.radius(k), from == k);
    % The smaller positive root. Comparisons with NaN are false, so a miss drops out.
    root = near;
    behind = !(near > 0);
    root(behind) = far(behind);
    closer = root > 0 & root < t;
    t(closer) = root(closer);
    id(closer) = k;
  end
end
