"""A session's results as HL7 FHIR R4 resources."""
