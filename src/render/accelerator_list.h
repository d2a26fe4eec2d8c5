// The kinds of accelerator; the first is what a scene gets that names none.
KIND(bvh)
KIND(kdtree)
KIND(sdf)
