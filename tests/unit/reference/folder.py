"""A reference set of a made-up clinic, to be spoiled by tests."""

MANIFEST = {
    "name": "clinic", "title": "Our people", "version": "3", "kind": "norms", "licence": "ours", "citation": "us, 2026",
    "population": "healthy", "n": 24, "ages": "20 to 40 years", "sensor": "shank sensors", "datum": "quiet standing",
    "notes": "",
}  # fmt: skip
HEADER = "measure,unit,sex,from_age,to_age,from_speed,to_speed,n,mean,sd,low,high,at_speed,per_speed"
ROWS = (
    "walking_speed,m/s,female,20,40,,,12,1.30,0.15,,,,",
    "walking_speed,m/s,male,20,40,,,12,1.36,0.16,1.10,1.65,,",
    "step_length,m,,20,40,0.8,1.6,24,0.62,0.03,,,1.2,0.3",
    "knee_flexion_range,rad,,,,,,24,1.0,0.08,,,,",
)


def write_set(root, rows=ROWS, header=HEADER, curves=None, **changes):
    fields = {key: value for key, value in (MANIFEST | changes).items() if value is not None}
    folder = root / fields["name"]
    folder.mkdir(parents=True)
    manifest = "\n".join(f"{key} = {value}" if key == "n" else f'{key} = "{value}"' for key, value in fields.items())
    (folder / "manifest.toml").write_text(manifest)
    (folder / "table.csv").write_text("\n".join([header, *rows]) + "\n")
    if curves is not None:
        (folder / "curves.csv").write_text("\n".join(["degree_of_freedom,percent,mean,sd", *curves]) + "\n")
    return folder
