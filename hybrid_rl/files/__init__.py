"""Files, also those of others: written whole or not at all, and judged before they are followed."""
