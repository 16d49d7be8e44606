"""Columns by name with their units."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    import pandas as pd
    import polars as pl
    import pyarrow as pa
    import xarray as xr


class Table(Mapping[str, NDArray[Any]]):
    """Columns of equal length by name: NumPy arrays, read-only where Carom made them.

    Parameters
    ----------
    columns : dict of str to ndarray, shape (rows,)
        The columns, which are not copied.
    units : dict of str to str, optional
        Unit label of every column; empty for counts, ratios and names.
    descriptions : dict of str to str, optional
        Meaning of the columns that have one.

    Examples
    --------
    >>> import numpy as np
    >>> table = carom.Table({"time": np.array([0.0, 0.5])}, {"time": "s"})
    >>> float(table["time"][1]), table.units["time"], table.rows
    (0.5, 's', 2)
    """

    def __init__(
        self,
        columns: Mapping[str, NDArray[Any]],
        units: Mapping[str, str] | None = None,
        descriptions: Mapping[str, str] | None = None,
    ) -> None:
        self._columns = dict(columns)
        self.units = {name: (units or {}).get(name, "") for name in self._columns}
        self.descriptions = dict(descriptions or {})

    def __getitem__(self, name: str) -> NDArray[Any]:
        try:
            return self._columns[name]
        except KeyError:
            import difflib

            near = difflib.get_close_matches(name, self._columns, n=1)
            hint = f"did you mean {near[0]!r}?" if near else f"the columns are: {', '.join(self._columns)}"
            raise KeyError(f"no column is named {name!r}; {hint}") from None

    def __iter__(self) -> Iterator[str]:
        return iter(self._columns)

    def __len__(self) -> int:
        return len(self._columns)

    @property
    def rows(self) -> int:
        """Number of rows."""
        return len(next(iter(self._columns.values()))) if self._columns else 0

    def __repr__(self) -> str:
        labels = [f"{name} ({self.units[name]})" if self.units[name] else name for name in self]
        return f"<Table of {self.rows} rows: {', '.join(labels)}>"

    def _repr_html_(self) -> str:
        return str(self.to_pandas().head(20).to_html())

    def to_pandas(self) -> pd.DataFrame:
        """For pandas.

        Returns
        -------
        pandas.DataFrame, shape (rows, columns)
            On the same memory; units are in ``attrs["units"]``.
        """
        import pandas as pd

        frame = pd.DataFrame(dict(self._columns), copy=False)
        frame.attrs["units"] = dict(self.units)
        return frame

    def to_arrow(self) -> pa.Table:
        """For Arrow.

        Returns
        -------
        pyarrow.Table, shape (rows, columns)
            On the same memory; units and meanings are metadata of its fields.
        """
        import pyarrow as pa

        arrays = [pa.array(values) for values in self._columns.values()]
        fields = [
            pa.field(name, array.type, metadata=_metadata(self.units[name], self.descriptions.get(name, "")))
            for name, array in zip(self, arrays)
        ]
        return pa.Table.from_arrays(arrays, schema=pa.schema(fields))

    def __arrow_c_stream__(self, requested_schema: object = None) -> object:
        """Arrow's C interface: ``polars.DataFrame(table)`` and others read it."""
        return self.to_arrow().__arrow_c_stream__(requested_schema)

    def to_polars(self) -> pl.DataFrame:
        """For polars, through Arrow's C interface.

        Returns
        -------
        polars.DataFrame, shape (rows, columns)
            On the same memory, but for texts.
        """
        import polars as pl

        return pl.DataFrame(self)

    def to_xarray(self) -> xr.Dataset:
        """For xarray.

        Returns
        -------
        xarray.Dataset
            Variables over ``time`` if there is such a column, else ``row``; units are attributes.
        """
        import xarray as xr

        over = "time" if "time" in self._columns else "row"
        variables = {
            name: xr.Variable(
                over, values, {"units": self.units[name], "long_name": self.descriptions.get(name, name)}
            )
            for name, values in self._columns.items()
        }
        return xr.Dataset(variables)

    @classmethod
    def _of_core(cls, columns: Mapping[str, Any], units: Mapping[str, str]) -> Table:
        """A table of arrays, and of lists of texts, that the compiled part made."""
        arrays = {name: np.asarray(values) for name, values in columns.items()}
        for values in arrays.values():
            values.setflags(write=False)
        return cls(arrays, units)

    @classmethod
    def of_arrow(cls, table: Any) -> Table:
        """A table from Arrow's, with the units that `to_arrow` stored.

        Parameters
        ----------
        table : pyarrow.Table
            Of `to_arrow`, or read from a Parquet file.

        Returns
        -------
        Table
            The table.
        """
        columns = {
            name: np.asarray(table.column(name).combine_chunks().to_numpy(zero_copy_only=False))
            for name in table.column_names
        }
        metadata = {field.name: field.metadata or {} for field in table.schema}
        units = {name: data.get(b"unit", b"").decode() for name, data in metadata.items()}
        meanings = {name: data.get(b"description", b"").decode() for name, data in metadata.items()}
        return cls(columns, units, {name: text for name, text in meanings.items() if text})


def _metadata(unit: str, description: str) -> dict[str, str]:
    return {key: text for key, text in (("unit", unit), ("description", description)) if text}
