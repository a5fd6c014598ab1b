"""From responses to statistics, tables, figures and the report."""
