% Distances at which rays o + t d meet one sphere: the roots of
%   (d.d) t^2 + 2 d.(o-c) t + (o-c).(o-c) - r^2 = 0,
% near <= far, both NaN for a miss. `leaves` marks the rays that start on this sphere.
% Their constant term is zero by definition, so one root is exactly 0 and the other is
% -2 d.(o-c) / d.d: no rounding can make a surface shadow or hit itself, at any scale,
% and no epsilon has to be chosen.
function [near, far] = sphere_roots(origin, direction, centre, radius, leaves)
  offset = origin - centre;
  a = sum(direction .^ 2, 2);
  half_b = sum(direction .* offset, 2);
  c = sum(offset .^ 2, 2) - radius ^ 2;
  c(leaves) = 0;

  discriminant = half_b .^ 2 - a .* c;
  miss = discriminant < 0;
  discriminant(miss) = 0;
  % -half_b and the square root are added with equal signs, so nothing cancels; the other
  % root comes from the product of the roots, c / a.
  away = 1 - 2 * (half_b < 0);
  q = -(half_b + away .* sqrt(discriminant));
  one = q ./ a;
  two = c ./ q;
  two(q == 0) = 0;
  near = min(one, two);
  far = max(one, two);
  near(miss) = NaN;
  far(miss) = NaN;
end
