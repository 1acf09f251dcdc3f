"""Products that keep their factors on their own axes."""

from __future__ import annotations

from functools import reduce
from math import log as natural_logarithm
from operator import mul
from typing import TYPE_CHECKING, Any

import equinox as eqx
import numpy as np
from jax.typing import ArrayLike
from jaxtyping import Array, Float
from numpy.typing import NDArray

from pitchpoint._jax import jnp

__all__ = [
    "Arrays",
    "Factored",
    "Numbers",
    "factored_product",
    "log",
    "product_array",
    "scaled",
    "square_root",
]


class Factored(eqx.Module):
    """A product of values of which each varies along axes of its own, such as positions or loads.

    Logarithms and powers are taken where the factors are: for a million states at a thousand positions
    and a thousand loads, of two thousand numbers. Everywhere else it is the array that it stands for.

    Attributes:
        factors: broadcast against each other.
    """

    factors: tuple[ArrayLike, ...]

    @property
    def merged(self) -> list[Numbers]:
        """Factors of one shape multiplied with each other, the smallest first."""
        product_of_shape: dict[tuple[int, ...], Any] = {}
        for factor in self.factors:
            shape = jnp.shape(factor)
            product_of_shape[shape] = (
                factor * product_of_shape[shape] if shape in product_of_shape else factor
            )
        # Small factors first: so most multiplications are done before the product has its full shape.
        return sorted(product_of_shape.values(), key=jnp.size)

    @property
    def value(self) -> Float[Array, "..."]:
        """The product as one array."""
        return jnp.asarray(reduce(mul, self.merged))

    @property
    def shape(self) -> tuple[int, ...]:
        """Shape of the product."""
        return np.broadcast_shapes(*map(jnp.shape, self.factors))

    @property
    def dtype(self) -> Any:
        """Type of the numbers of the product."""
        return jnp.result_type(*self.factors)

    def __jax_array__(self) -> Array:
        return self.value

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> NDArray[Any]:
        return np.asarray(self.value, dtype)

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        return getattr(self.value, name)

    def __mul__(self, other: Any) -> Factored:
        factors = other.factors if isinstance(other, Factored) else (other,)
        return Factored((*self.factors, *factors))

    __rmul__ = __mul__

    def __truediv__(self, other: Any) -> Factored:
        over: Any = other**-1.0 if isinstance(other, Factored) else 1.0 / other
        quotient: Factored = self * over
        return quotient

    def __rtruediv__(self, other: Any) -> Factored:
        quotient: Factored = self**-1.0 * other
        return quotient

    def __pow__(self, power: ArrayLike) -> Factored:
        if any(isinstance(factor, int | float) and factor < 0 for factor in self.factors):
            return Factored((self.value**power,))  # two negative factors have a positive product
        return Factored(tuple(factor**power for factor in self.merged))

    def __abs__(self) -> Factored:
        return Factored(tuple(map(jnp.abs, self.merged)))


def _on_value(name: str) -> Any:
    def operator(self: Factored, *others: Any) -> Any:
        return getattr(self.value, name)(*map(product_array, others))

    return operator


_OPERATORS = "add radd sub rsub rpow mod rmod floordiv rfloordiv matmul neg pos"
_QUESTIONS = "lt le gt ge eq ne getitem len iter"
for _name in [*_OPERATORS.split(), *_QUESTIONS.split()]:
    setattr(Factored, f"__{_name}__", _on_value(f"__{_name}__"))


if TYPE_CHECKING:  # which need not tell them apart
    Arrays = Array
    Numbers = Array
else:
    Arrays = Array | np.ndarray
    Numbers = Arrays | float | Factored
"""`Arrays` of JAX or, outside of programs, of NumPy; `Numbers` are all that calculates as they do."""


def scaled(value: Factored | ArrayLike, by: float) -> Any:
    """A value times a number, as in a change of unit; a product stays one."""
    return value * by if isinstance(value, Factored) else jnp.asarray(value) * by


def factored_product(*factors: ArrayLike) -> Any:
    """Product that keeps its factors, for whoever takes an array."""
    return Factored(factors)


def product_array(value: Any) -> Any:
    """The value itself, or the array that a product stands for."""
    return value.value if isinstance(value, Factored) else value


def log(value: Factored | ArrayLike, least: float) -> Float[Array, "..."]:
    """Natural logarithm, of a product as a sum over its factors.

    Args:
        value: not negative.
        least: positive; values below it count as it.
    """
    merged = value.merged if isinstance(value, Factored) else [jnp.asarray(value)]
    return jnp.maximum(sum(map(_log, merged)), natural_logarithm(least))


def _log(value: Numbers) -> Array:
    # Compiled programs flush what is smaller to zero, and its logarithm would be minus infinity.
    tiny = float(np.finfo(jnp.result_type(value, jnp.float32)).tiny)
    return jnp.log(jnp.where(value > tiny, value, tiny))


def square_root(square: Float[Numbers, "..."]) -> Any:
    """Square root with a zero gradient at zero instead of an infinite one."""
    if isinstance(square, Factored):
        return Factored(tuple(map(square_root, square.merged)))
    return jnp.where(square > 0.0, jnp.sqrt(jnp.where(square > 0.0, square, 1.0)), 0.0)
