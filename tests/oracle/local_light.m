% Local light of points on spheres `id` (B. T. Phong, "Illumination for Computer Generated
% Pictures", CACM 18(6), 1975):
%   ka Ia + sum over lights [ kd max(0, L.N) + ks max(0, R.V)^n ] Il.
% `normal` faces the viewer, `view` points to him; a light behind that normal adds
% nothing, nor does a hidden one. Bit l of `lit` says whether light l reaches the point.
function [color, lit] = local_light(scene, point, normal, view, id)
  color = scene.ambient_color(id, :) .* scene.ambient;
  lit = zeros(rows(point), 1);
  for l = 1:numel(scene.lights)
    light = scene.lights(l);
    to_light = light.from - point;
    distance2 = sum(to_light .^ 2, 2);
    L = to_light ./ sqrt(distance2);
    front = find(sum(L .* normal, 2) > 0)(:);   % a column even when empty
    seen = front(!shadowed(scene, point(front, :), to_light(front, :), id(front)))(:);
    lit(seen) += 2 ^ (l - 1);

    L = L(seen, :);
    N = normal(seen, :);
    cosine = sum(L .* N, 2);
    R = 2 * cosine .* N - L;
    glint = max(0, sum(R .* view(seen, :), 2)) .^ scene.shininess(id(seen));
    if light.inverse_square
      intensity = light.intensity ./ distance2(seen);
    else
      intensity = repmat(light.intensity, numel(seen), 1);
    end
    color(seen, :) += (scene.diffuse(id(seen), :) .* cosine ...
                       + scene.specular(id(seen), :) .* glint) .* intensity;
  end
end
