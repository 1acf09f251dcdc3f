"""Line contacts of which a test sets what it looks at."""

from pitchpoint._jax import jnp
from pitchpoint.contact.contacts import Contacts


def line_contacts(**given):
    """Contacts that lie at the origin, their normals and tangents along x and y."""
    lanes = jnp.shape(given["path"])
    axes = [jnp.zeros((3, *lanes)).at[k].set(1.0) for k in (0, 1)]
    frame = {"point": jnp.zeros((3, *lanes)), "direction": axes[0], "tangent": axes[1]}
    return Contacts(**frame, **given, shape="line")
