"""Backcast in the place of nav2_amcl."""
