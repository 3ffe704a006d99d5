"""The pose problem (eqs 17-22) compiled: a small SQP with exact first and second derivatives."""
