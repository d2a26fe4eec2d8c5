% Refracted unit direction by Snell's law, eta1 sin(theta1) = eta2 sin(theta2).
% `outward` is the geometric outward normal and `eta` the index inside over the index
% outside: the sign of D.N tells entering from leaving. `total` marks total internal
% reflection, where the mirrored direction is returned instead.
function [refracted, total] = refract_ray(direction, outward, eta)
  leaving = sum(direction .* outward, 2) > 0;
  facing = outward .* (1 - 2 * leaving);
  ratio = 1 ./ eta;                      % eta1 / eta2
  ratio(leaving) = eta(leaving);
  cos1 = -sum(direction .* facing, 2);
  sin2_squared = ratio .^ 2 .* (1 - cos1 .^ 2);
  total = sin2_squared > 1;
  cos2 = sqrt(max(0, 1 - sin2_squared));
  refracted = ratio .* direction + (ratio .* cos1 - cos2) .* facing;
  mirrored = reflect_ray(direction, facing);
  refracted(total, :) = mirrored(total, :);
end
