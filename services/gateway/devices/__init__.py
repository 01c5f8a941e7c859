"""What a clinic measures with: sensor sets and cameras."""
