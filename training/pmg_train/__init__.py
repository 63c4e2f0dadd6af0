"""Training of PMG policies on the deployed generator's references."""
