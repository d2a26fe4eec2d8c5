// The kinds of camera; the first is what a scene gets that names none.
KIND(perspective)
KIND(orthographic)
KIND(spherical)
KIND(realistic)
