% True where a silhouette, a shadow edge or another change of the ray tree lies between a
% pixel and one of its eight neighbours, that is, where their signatures differ (see
% trace_rays). A float renderer can put a pixel on the other side of an edge only if that
% edge lies within rounding of the pixel's centre, hence between it and a neighbour.
function mask = edge_mask(signature)
  [width, height] = size(signature);
  mask = false(width, height);
  for dx = -1:1
    for dy = -1:1
      x = min(max((1:width) + dx, 1), width);
      y = min(max((1:height) + dy, 1), height);
      mask |= signature != signature(x, y);
    end
  end
end
