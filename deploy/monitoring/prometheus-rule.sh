#!/usr/bin/env bash
# Writes prometheus-rule.yaml: the groups of rules/*.yml as one object of the Prometheus operator.
set -euo pipefail
cd "$(dirname "$0")"
{
  echo "# Made by prometheus-rule.sh of rules/*.yml; change those."
  echo "apiVersion: monitoring.coreos.com/v1"
  echo "kind: PrometheusRule"
  echo "metadata:"
  echo "  name: traverse"
  echo "  labels: {app.kubernetes.io/name: traverse}"
  echo "spec:"
  echo "  groups:"
  for file in rules/recording.yml rules/alerts.yml; do
    sed -e '1,/^groups:/d' -e 's/^\(.\)/  \1/' "$file"
  done
} >"${1:-prometheus-rule.yaml}"
