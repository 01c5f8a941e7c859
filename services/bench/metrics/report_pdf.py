"""What a PDF really holds, read with pypdf: tags, words for figures, colours of text."""

import io
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from pypdf import PdfReader
from pypdf.generic import ContentStream, DictionaryObject

SHOWS_TEXT = (b"Tj", b"TJ", b"'", b'"')
SETS_COLOUR = (b"rg", b"g", b"sc", b"scn")


@dataclass(frozen=True)
class Printed:
    """One document as a reader program finds it."""

    pages: int
    tagged: bool
    ua: bool
    language: str
    title: str
    kinds: dict[str, int]
    """Number of structure elements by kind."""
    figures_without_words: int
    text_colours: frozenset[str]


def printed(pdf: bytes) -> Printed:
    """Read a PDF."""
    reader = PdfReader(io.BytesIO(pdf))
    root: Any = reader.trailer["/Root"]
    elements = list(_elements(root["/StructTreeRoot"])) if "/StructTreeRoot" in root else []
    kinds: dict[str, int] = {}
    for each in elements:
        kind = str(each["/S"]).removeprefix("/")
        kinds[kind] = kinds.get(kind, 0) + 1
    return Printed(
        pages=len(reader.pages),
        tagged=bool("/MarkInfo" in root and root["/MarkInfo"].get("/Marked")),
        ua=b"pdfuaid:part>1<" in root["/Metadata"].get_object().get_data(),
        language=str(root.get("/Lang", "")),
        title="" if reader.metadata is None else reader.metadata.title or "",
        kinds=kinds,
        figures_without_words=sum(each["/S"] == "/Figure" and not each.get("/Alt") for each in elements),
        text_colours=frozenset(colour for page in reader.pages for colour in _text_colours(reader, page, page)),
    )


def _elements(node: Any) -> Iterator[Any]:
    node = node.get_object() if hasattr(node, "get_object") else node
    if not isinstance(node, DictionaryObject):
        return
    if "/S" in node:
        yield node
    kids = node.get("/K", [])
    for kid in kids if isinstance(kids, list) else [kids]:
        yield from _elements(kid)


def _text_colours(reader: PdfReader, holder: Any, content: Any) -> Iterator[str]:
    """Colours in which a page or a form shows text, `#RRGGBB`, and of the forms that it draws."""
    stream = content.get("/Contents", content)
    resources = holder.get("/Resources", DictionaryObject()).get_object()
    forms = resources.get("/XObject", DictionaryObject()).get_object()
    colour = "#000000"
    kept: list[str] = []
    for operands, operator in ContentStream(stream.get_object(), reader).operations:
        if operator == b"q":
            kept.append(colour)
        elif operator == b"Q" and kept:
            colour = kept.pop()
        elif operator in SETS_COLOUR:
            colour = _hexadecimal(operands) or colour
        elif operator in SHOWS_TEXT:
            yield colour
        elif operator == b"Do":
            form = forms[operands[0]].get_object()
            if form.get("/Subtype") == "/Form":
                yield from _text_colours(reader, form, form)


def _hexadecimal(operands: list[Any]) -> str | None:
    parts = [float(part) for part in operands if not isinstance(part, str)]
    if len(parts) == 1:
        parts *= 3
    return "#" + "".join(f"{round(255 * part):02X}" for part in parts) if len(parts) == 3 else None
