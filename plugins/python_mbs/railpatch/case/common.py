"""Tables that every kind of case has."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BeforeValidator, Field, WithJsonSchema, model_validator

from railpatch.case.types import (
    CountPair,
    NotNegative,
    Positive,
    PositivePair,
    RatioPair,
    Table,
    exactly_one,
    twice,
)


def either(item: dict[str, object]) -> WithJsonSchema:
    """JSON schema of one number or [wheel, rail]."""
    pair = {"type": "array", "items": item, "minItems": 2, "maxItems": 2}
    return WithJsonSchema({"anyOf": [item, pair]})


class Material(Table):
    """Elastic constants of wheel and rail; steel where the table is left out."""

    shear_modulus: Annotated[
        PositivePair,
        BeforeValidator(twice),
        either({"type": "number", "exclusiveMinimum": 0}),
    ] = Field(default=[82e9, 82e9], description="Pa, shear modulus, or [wheel, rail]")
    poisson_ratio: Annotated[
        RatioPair,
        BeforeValidator(twice),
        either({"type": "number", "minimum": 0, "maximum": 0.5}),
    ] = Field(default=[0.28, 0.28], description="-, Poisson's ratio, or [wheel, rail]")


class Grid(Table):
    """Elements of the potential contact: by number or by size."""

    elements: CountPair | None = Field(
        default=None,
        description="-, elements across the contact's bounding box [along rolling, lateral]",
    )
    element_size: PositivePair | None = Field(
        default=None, description="m, size of an element [along rolling, lateral]"
    )
    max_elements: CountPair | None = Field(
        default=None,
        description="-, capacity of one patch's grid [along rolling, lateral]; left out: chosen "
        "from the scene",
    )

    @model_validator(mode="after")
    def _one_way(self) -> Grid:
        exactly_one(self, ("elements", "element_size"))
        return self


class Friction(Table):
    """Friction law."""

    law: Literal["coulomb"] = Field(default="coulomb", description="friction law (no unit)")
    coefficient: NotNegative = Field(description="-, coefficient of friction")


class Layer(Table):
    """Elastic third-body layer; the table is left out for none."""

    shear_modulus: Positive = Field(description="Pa, shear modulus of the layer")
    thickness: NotNegative = Field(description="m, thickness of the layer; 0: no layer")


class Method(Table):
    """Which theory solves which problem."""

    normal: Literal["hertz", "half_space"] = Field(
        default="half_space", description="theory of the normal problem (no unit)"
    )
    tangential: Literal["none", "fastsim", "full"] = Field(
        default="full", description="theory of the tangential problem (no unit)"
    )
    tolerance: Annotated[float, Field(ge=1e-12, le=1e-1)] = Field(
        default=1e-5, description="-, relative tolerance of the solvers"
    )
    max_iterations: Annotated[int, Field(ge=1, le=1_000_000)] | None = Field(
        default=None, description="-, most iterations of each solver; left out: the core's choice"
    )
    spin_offset: Literal["none", "sixth"] = Field(
        default="none",
        description="-, shift of the spin term in elements along rolling: none, or a sixth as in "
        "the program CONTACT, for comparisons",
    )
