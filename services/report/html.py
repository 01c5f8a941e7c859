"""A report as one stand-alone page: no script, nothing from elsewhere, charts as they are; prints on A4."""

from html import escape
from importlib.resources import files

from schemas.vocabulary import Side
from services.report.charts import colours
from services.report.charts.canvas import FONT
from services.report.content import Cell, Chart, Column, Report, Row, Section, Table


def page(report: Report) -> str:
    """The whole document."""
    head, title = report.header, escape(f"{report.header.title} {report.id}")
    quality = head.quality
    facts = "".join(f"<div><dt>{escape(each.label)}</dt><dd>{escape(each.text)}</dd></div>" for each in head.facts)
    warnings = "".join(f"<p>{escape(each)}</p>" for each in quality.warnings)
    grade = quality.grade or "unknown"
    parts = [
        f'<!doctype html><html lang="{report.language}"><head><meta charset="utf-8"><title>{title}</title>',
        '<meta name="viewport" content="width=device-width, initial-scale=1">',
        f"<style>{_style()}</style></head><body>",
        f'<header><div class="title"><h1>{escape(head.title)}</h1><p>{escape(head.subtitle)}</p></div>',
        f"<dl>{facts}</dl>",
        f'<div class="quality"><p><strong class="{grade}">{escape(quality.title)}.</strong> ',
        f"{escape(quality.text)}.</p>{warnings}</div></header>",
        "<main>",
        *(_section(each) for each in report.sections),
        "</main>",
        f"<footer><p>{escape(' · '.join(report.footer.items))}</p>",
        f"<p><strong>{escape(report.footer.disclaimer)}</strong></p></footer></body></html>",
    ]
    return "".join(parts)


def _style() -> str:
    values = {
        "font": FONT, "ink": colours.INK, "soft": colours.SOFT_INK, "line": colours.LINE, "grid": colours.GRID,
        "head": colours.HEAD_GROUND, "accent": colours.WHOLE, "good": colours.GOOD, "fair": colours.FAIR,
        "poor": colours.POOR, "left": colours.SIDE[Side.LEFT], "right": colours.SIDE[Side.RIGHT],
    }  # fmt: skip
    rules = files("services.report").joinpath("page.css").read_text(encoding="utf-8")
    variables = ";".join(f"--{name}:{value}" for name, value in values.items())
    return f":root{{{variables}}}{rules}"


def _section(section: Section) -> str:
    listed = "".join(f"<li>{escape(each)}</li>" for each in section.sentences)
    charts = "".join(_chart(each) for each in section.charts)
    notes = f'<p class="notes">{escape(" ".join(section.notes))}</p>' if section.notes else ""
    return (
        f'<section id="{section.id}" class="page{section.page}"><h2>{escape(section.title)}</h2>'
        f"{f'<ul>{listed}</ul>' if listed else ''}"
        f"{f'<div class=charts>{charts}</div>' if charts else ''}"
        f"{_table(section.table) if section.table else ''}{notes}</section>"
    )


def _chart(chart: Chart) -> str:
    return f'<figure class="w{chart.columns}"><figcaption>{escape(chart.title)}</figcaption>{chart.svg}</figure>'


def _table(table: Table) -> str:
    heads = "".join(_head(column) for column in table.columns)
    rows = "".join(_row(row) for row in table.rows)
    caption = f'<caption class="unseen">{escape(table.caption)}</caption>'
    return f"<table>{caption}<thead><tr>{heads}</tr></thead><tbody>{rows}</tbody></table>"


def _head(column: Column) -> str:
    kinds = [column.side or "", "number" if column.numeric else ""]
    return f'<th scope="col" class="{" ".join(kind for kind in kinds if kind)}">{escape(column.head)}</th>'


def _row(row: Row) -> str:
    note = f" <small>{escape(row.note)}</small>" if row.note else ""
    return f'<tr><th scope="row">{escape(row.head)}{note}</th>{"".join(_cell(each) for each in row.cells)}</tr>'


def _cell(cell: Cell) -> str:
    span = f' colspan="{cell.span}"' if cell.span > 1 else ""
    note = f" <small>{escape(cell.note)}</small>" if cell.note else ""
    return f'<td{span} class="{cell.tone}">{escape(cell.text)}{note}</td>'
