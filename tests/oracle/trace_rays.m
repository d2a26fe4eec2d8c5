% Colour of an array of rays, by the recursion
%   trace(ray, depth) = (1 - kr) local + kr trace(mirrored, depth - 1)
%                                      + kt trace(refracted, depth - 1),
% black at depth 0 and where nothing is hit. `from` numbers the spheres the rays start on.
%
% `signature` is a hash of the ray tree: at each node the sphere, the side it was hit
% from, the lights that reach it and whether reflection was total. Between two pixels of
% equal signature the picture is smooth; a change marks an edge. Nodes that add less than
% a visible share (`weight`, the product of the kr and kt above) are left out of it.
function [color, signature] = trace_rays(scene, origin, direction, from, depth, weight)
  color = zeros(rows(direction), 3);
  signature = zeros(rows(direction), 1);
  if depth == 0 || rows(direction) == 0
    return;
  end

  [t, id] = intersect_scene(scene, origin, direction, from);
  hit = find(id)(:);
  id = id(hit);
  weight = weight(hit);
  D = direction(hit, :);
  point = origin(hit, :) + t(hit) .* D;
  outward = (point - scene.centre(id, :)) ./ scene.radius(id);
  leaving = sum(D .* outward, 2) > 0;
  normal = outward .* (1 - 2 * leaving);

  kr = scene.reflectivity(id);
  kt = scene.transparency(id);
  [local, lit] = local_light(scene, point, normal, -D, id);
  color(hit, :) = (1 - kr) .* local;
  node = id + (rows(scene.centre) + 1) * (leaving + 4 * lit);
  [refracted, total] = refract_ray(D, outward, scene.eta(id));
  node += (rows(scene.centre) + 1) * 2 * (total & kt > 0);

  [seen, sign_r] = branch(scene, point, reflect_ray(D, normal), id, depth, weight, kr);
  color(hit, :) += seen;
  [seen, sign_t] = branch(scene, point, refracted, id, depth, weight, kt);
  color(hit, :) += seen;

  % Linear congruential mixing: every product stays below 2^53, so it is exact.
  modulus = 2 ^ 31 - 1;
  hashed = mod(48271 * mod(node, modulus) + 69621 * sign_r + 39373 * sign_t, modulus);
  signature(hit) = hashed;
end

% share * trace(...) for the rays whose share is not zero. Signatures are kept only where
% the weight can still move a channel by about the tolerance of the comparison.
function [seen, signature] = branch(scene, point, direction, id, depth, weight, share)
  visible = 5e-4;
  seen = zeros(rows(direction), 3);
  signature = zeros(rows(direction), 1);
  weight = weight .* share;
  on = find(share > 0)(:);
  [color, tree] = trace_rays(scene, point(on, :), direction(on, :), id(on), depth - 1, weight(on));
  seen(on, :) = share(on) .* color;
  signature(on) = tree .* (weight(on) > visible);
end
